#include "cmap/report/figure_module.hpp"

#include "cmap/core/loaded_module.hpp"

namespace cmap {

FigureModule::FigureModule()
    : table_(load_module<FigureTable>(
          "libcmap_figure.so", "this build has no figures (tools/install_dependencies.sh --all, build again)")) {}

}  // namespace cmap
