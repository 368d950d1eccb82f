#pragma once

#include <vtkGenericOpenGLRenderWindow.h>

#include "gl/egl_context.hpp"

namespace cmap {

/// A window of VTK that draws into an EGL context: Debian's VTK has none without an X server. vtkNew gives one; throws
/// UsageError where there is no OpenGL.
class EglWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static EglWindow* New();
  vtkTypeMacro(EglWindow, vtkGenericOpenGLRenderWindow);

  void MakeCurrent() override { context_.make_current(); }
  bool IsCurrent() override { return context_.is_current(); }
  void OpenGLInitContext() override;

 protected:
  EglWindow();
  ~EglWindow() override;

 private:
  EglContext context_;
};

}  // namespace cmap
