#include "cmap/core/loaded_module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include "cmap/core/error.hpp"
#include "cmap/core/version.hpp"
#include "execution_state.hpp"
#include "host_settings.hpp"

namespace cmap {
namespace {

constexpr const char* kRemedy = "install programs and modules of one build";

std::string path_of(void* library) {
  link_map* map = nullptr;
  return ::dlinfo(library, RTLD_DI_LINKMAP, &map) == 0 ? map->l_name : "a module";
}

}  // namespace

std::string module_build(const char* module, int table) {
  return fmt::format("cmap {}, {} table {}", kVersion, module, table);
}

void take_over(const ModuleHost& host) {
  take_execution_from(host.execution);
  take_simd_level(host.simd);
}

const void* load_table(const std::string& file, const std::string& build, const std::string& missing) {
  void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw UnsupportedError(fmt::format("{}: {}", missing, ::dlerror()));
  void* entry = ::dlsym(library, "cmap_module");
  if (entry == nullptr) {
    throw UnsupportedError(fmt::format("{}: is no module of {}; {}", path_of(library), build, kRemedy));
  }
  const ModuleHost host{current_execution, simd_level()};
  const ModuleAnswer answer = reinterpret_cast<decltype(&cmap_module)>(entry)(build.c_str(), &host);
  if (answer.table == nullptr) {
    throw UnsupportedError(
        fmt::format("{}: is of {}, needed is {}; {}", path_of(library), answer.build, build, kRemedy));
  }
  return answer.table;
}

}  // namespace cmap
