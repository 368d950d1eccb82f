#include <fmt/format.h>

#include <cstdlib>

#include "cmap/core/error.hpp"
#include "cmap/gl/viewer.hpp"

// Last: X11 defines macros with common names.
#include <GL/glx.h>

namespace cmap {
namespace {

bool has_gl_windows(Display* display) {
  int wanted[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 1, 0};
  if (!glXQueryExtension(display, nullptr, nullptr)) return false;
  XVisualInfo* visual = glXChooseVisual(display, DefaultScreen(display), wanted);
  if (visual == nullptr) return false;
  XFree(visual);
  return true;
}

}  // namespace

void require_display() {
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0') {
    throw UsageError("--interactive needs an X display: DISPLAY is not set (without one, -o FILE writes a picture)");
  }
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr) throw UsageError(fmt::format("--interactive: the X display {} cannot be opened", name));
  const bool usable = has_gl_windows(display);
  XCloseDisplay(display);
  if (!usable) throw UsageError(fmt::format("--interactive: the X display {} has no OpenGL windows", name));
}

}  // namespace cmap
