#include "cmap/core/loaded_module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

#include "cmap/core/error.hpp"

namespace cmap {

LoadedModule::LoadedModule(const char* library, const char* missing)
    : library_(::dlopen(library, RTLD_NOW | RTLD_LOCAL)) {
  if (library_ == nullptr) throw UnsupportedError(fmt::format("{}: {}", missing, ::dlerror()));
}

void* LoadedModule::address(const char* name) const {
  void* found = ::dlsym(library_, name);
  if (found == nullptr) throw std::logic_error(::dlerror());
  return found;
}

}  // namespace cmap
