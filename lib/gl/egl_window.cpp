#include "egl_window.hpp"

#include <vtkObjectFactory.h>
#include <vtkOpenGLState.h>
#include <vtk_glew.h>

#include "cmap/core/error.hpp"

namespace cmap {

vtkStandardNewMacro(EglWindow);

EglWindow::EglWindow() {
  SetUseOffScreenBuffers(true);
  SetSupportsOpenGL(1);
  SetIsDirect(1);
  // What SetOwnContext and its kin leave to the caller: nobody else draws here.
  SetReadyForRendering(true);
}

EglWindow::~EglWindow() { Finalize(); }

void EglWindow::OpenGLInitContext() {
  if (Initialized) return;
  ContextCreationTime.Modified();
  // Debian's GLEW looks for GLX last, when all entry points are loaded: there is no X display here, and none is needed.
  constexpr GLenum kNoGlxDisplay = 4;
  glewExperimental = GL_TRUE;
  const GLenum result = glewInit();
  GlewInitValid = result == GLEW_OK || result == kNoGlxDisplay;
  if (!GlewInitValid) throw UsageError("no OpenGL device: its functions cannot be loaded");
  Initialized = true;
  GetState()->Initialize(this);
}

}  // namespace cmap
