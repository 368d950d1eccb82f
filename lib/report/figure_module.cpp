#include "cmap/report/figure_module.hpp"

#include "cmap/core/loaded_module.hpp"

namespace cmap {

FigureModule::FigureModule() {
  const LoadedModule module("libcmap_figure.so",
                            "this build has no figures (tools/install_dependencies.sh --all, build again)");
  module.find("cmap_figure_check_name", check_name_);
  module.find("cmap_figure_write", write_);
  module.find("cmap_figure_write_drawing", write_drawing_);
}

}  // namespace cmap
