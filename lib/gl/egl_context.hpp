#pragma once

#include <EGL/egl.h>

namespace cmap {

/// An OpenGL context without window, surface or display server. Lives and dies in one thread.
class EglContext {
 public:
  /// On the first device that gives one: GPUs before software, then Mesa's surfaceless platform. Throws UsageError
  /// where none does.
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Throws std::runtime_error.
  void make_current();
  bool is_current() const;

 private:
  bool open(EGLDisplay display);

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace cmap
