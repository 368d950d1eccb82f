#include "egl_context.hpp"

#include <EGL/eglext.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

template <class Function>
Function egl_function(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

bool contains(const char* extensions, std::string_view name) {
  return extensions != nullptr && std::string_view(extensions).find(name) != std::string_view::npos;
}

/// GPUs first.
std::vector<EGLDeviceEXT> devices() {
  const auto query = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto extensions_of = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  EGLint n = 0;
  if (query == nullptr || extensions_of == nullptr || !query(0, nullptr, &n)) return {};
  std::vector<EGLDeviceEXT> found(static_cast<std::size_t>(n));
  if (!query(n, found.data(), &n)) return {};
  found.resize(static_cast<std::size_t>(n));
  std::ranges::stable_partition(found, [&](EGLDeviceEXT device) {
    return !contains(extensions_of(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
  });
  return found;
}

/// The default display would need a display server.
std::vector<EGLDisplay> displays() {
  const auto get = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  std::vector<EGLDisplay> found;
  if (get == nullptr) return found;
  for (EGLDeviceEXT device : devices()) found.push_back(get(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
  found.push_back(get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  std::erase(found, EGL_NO_DISPLAY);
  return found;
}

}  // namespace

EglContext::EglContext() {
  for (EGLDisplay display : displays()) {
    if (open(display)) return;
  }
  throw UsageError(
      "no OpenGL device: EGL finds neither a GPU nor Mesa's software (apt-get install libegl1 libgl1-mesa-dri)");
}

EglContext::~EglContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  // The display is not ours alone: another context of this process may use it.
}

bool EglContext::open(EGLDisplay display) {
  const EGLint config_attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  const EGLint context_attributes[] = {
      EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 0, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint n_configs = 0;
  if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API) ||
      !eglChooseConfig(display, config_attributes, &config, 1, &n_configs) || n_configs == 0) {
    return false;
  }
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, context_attributes);
  if (context == EGL_NO_CONTEXT) return false;
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(display, context);
    return false;
  }
  display_ = display;
  context_ = context;
  return true;
}

void EglContext::make_current() {
  if (!is_current() && !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
    throw std::runtime_error("EGL cannot make its context current");
  }
}

bool EglContext::is_current() const { return eglGetCurrentContext() == context_; }

}  // namespace cmap
