// What cmap_eval loads when a figure is asked for; see cmap/report/figure_module.hpp.

#include "cmap/render/drawing_image.hpp"
#include "cmap/render/image.hpp"
#include "cmap/render/standard_figure.hpp"

extern "C" {

void cmap_figure_check_name(const std::filesystem::path& name) { cmap::check_image_name(name); }

void cmap_figure_write(const cmap::Evaluation& evaluation, const std::filesystem::path& name, cmap::OutputFile& file) {
  cmap::write_standard_figure(evaluation, name, file);
}

void cmap_figure_write_drawing(const cmap::Drawing& drawing, const std::filesystem::path& name,
                               cmap::OutputFile& file) {
  constexpr double kPixelsOfUnit = 2.0;
  cmap::write_image(cmap::image_of(drawing, kPixelsOfUnit), name, file);
}
}
