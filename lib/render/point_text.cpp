#include "cmap/render/point_text.hpp"

#include <fmt/format.h>

namespace cmap {

std::vector<std::string> describe_point(const IndexedMap& map, std::size_t slot) {
  const Eigen::Vector3d p = map.index.points.world(slot);
  std::vector<std::string> lines{fmt::format("x {:.3f}  y {:.3f}  z {:.3f} m", p.x(), p.y(), p.z())};
  if (map.has_color()) {
    const Eigen::Vector3d c = map.color(slot);
    lines.push_back(map.has_color_at(slot) ? fmt::format("color {:.4g} {:.4g} {:.4g} of 255", c[0], c[1], c[2])
                                           : "no color");
  }
  return lines;
}

std::vector<std::string> describe_point(const EvaluatedPair& evaluation, const PointBlocks& points, std::size_t slot) {
  const MapPair& pair = evaluation.pair;
  const bool of_reference = &points == &pair.reference.index.points;
  const NearestPairs pairs = of_reference ? pair.reference_to_estimate() : pair.estimate_to_reference();
  std::vector<std::string> lines{of_reference ? "point of the reference" : "point of the estimate"};
  for (std::string& line : describe_point(pairs.from, slot)) lines.push_back(std::move(line));
  const char* other = of_reference ? "estimate" : "reference";
  lines.push_back(fmt::format("distance to the {} {:.4g} m", other, pairs.distance_m(slot)));
  if (pair.has_color() && pairs.has_colors(slot)) {
    lines.push_back(fmt::format("color distance {:.4g} unit RGB", pairs.color_distance(slot)));
  }
  if (of_reference && evaluation.recall) {
    lines.push_back(fmt::format("local color recall: {}", look_of(evaluation.recall->classes[slot]).label));
  }
  return lines;
}

}  // namespace cmap
