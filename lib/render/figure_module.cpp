// What programs load when a figure is asked for.

#include "cmap/report/figure_module.hpp"

#include "cmap/core/loaded_module.hpp"
#include "cmap/render/alignment_figure.hpp"
#include "cmap/render/drawing_image.hpp"
#include "cmap/render/image.hpp"
#include "cmap/render/standard_figure.hpp"

namespace cmap {
namespace {

void write_drawing(const Drawing& drawing, const std::filesystem::path& name, OutputFile& file) {
  constexpr double kPixelsOfUnit = 2.0;
  write_image(image_of(drawing, kPixelsOfUnit), name, file);
}

constexpr FigureTable kTable{.check_name = check_image_name,
                             .write = write_standard_figure,
                             .write_alignment = write_alignment_figure,
                             .write_drawing = write_drawing};

}  // namespace
}  // namespace cmap

cmap::ModuleAnswer cmap_module(const char* build, const cmap::ModuleHost* host) {
  return cmap::answer_of_module(cmap::kTable, build, host);
}
