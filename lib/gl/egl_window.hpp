#pragma once

#include <vtkGenericOpenGLRenderWindow.h>

#include "egl_context.hpp"

namespace cmap {

/// A window of VTK that draws into an EGL context: Debian's VTK has none without an X server.
class EglWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static EglWindow* New();
  vtkTypeMacro(EglWindow, vtkGenericOpenGLRenderWindow);

  /// Before anything else; must outlive the window.
  void use(EglContext& context) { context_ = &context; }

  void MakeCurrent() override { context_->make_current(); }
  bool IsCurrent() override { return context_->is_current(); }
  /// Throws UsageError where OpenGL's functions cannot be loaded.
  void OpenGLInitContext() override;

 protected:
  EglWindow();
  ~EglWindow() override;

 private:
  EglContext* context_ = nullptr;
};

}  // namespace cmap
