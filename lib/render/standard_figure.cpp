#include "cmap/render/standard_figure.hpp"

#include "cmap/render/figure.hpp"

namespace cmap {

std::vector<std::string> standard_panels(const EvaluatedPair& evaluation) {
  std::vector<std::string> panels{"reference", "estimate"};
  if (evaluation.recall) panels.emplace_back("lcr");
  panels.emplace_back(evaluation.pair.has_color() ? "color-distance" : "distance");
  return panels;
}

void write_standard_figure(const EvaluatedPair& evaluation, const std::filesystem::path& name, OutputFile& file) {
  std::vector<Layer> layers;
  for (const std::string& panel : standard_panels(evaluation)) layers.push_back(make_layer(evaluation, panel));
  const FigureOptions options;
  const Camera camera =
      camera_for(View::kOblique, evaluation.pair.reference.index.points, panel_aspect(layers.size(), options), false);
  write_image(draw_figure(layers, camera, options), name, file);
}

}  // namespace cmap
