#pragma once

namespace cmap {

/// A shared library of ours that needs heavy ones: loaded when its feature is asked for, so that programs start
/// without.
class LoadedModule {
 public:
  /// Found by the program's run path; never unloaded, as VTK's libraries do not survive that. Throws UnsupportedError
  /// that begins with `missing` where this build has none.
  LoadedModule(const char* library, const char* missing);

  template <class Function>
  void find(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(address(name));
  }

 private:
  void* address(const char* name) const;
  void* library_;
};

}  // namespace cmap
