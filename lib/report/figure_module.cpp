#include "cmap/report/figure_module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

template <class Function>
void find_function(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  if (function == nullptr) throw UnsupportedError(fmt::format("figures: {}", ::dlerror()));
}

}  // namespace

FigureModule::FigureModule() {
  // Found by the program's run path; never unloaded, as VTK's libraries do not survive that.
  void* library = ::dlopen("libcmap_figure.so", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw UnsupportedError(fmt::format("no figures in this build: {}", ::dlerror()));
  find_function(library, "cmap_figure_check_name", check_name_);
  find_function(library, "cmap_figure_write", write_);
  find_function(library, "cmap_figure_write_drawing", write_drawing_);
}

}  // namespace cmap
