#include "cmap/eval/point_errors.hpp"

#include "cmap/core/color.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {
namespace {

/// The map in its own order; colors as 8 bit.
PointCloud point_cloud(const IndexedMap& map) {
  const PointBlocks& points = map.index.points;
  PointCloud cloud;
  cloud.origin = points.origin;
  cloud.positions.resize(points.size);
  Array<Rgb8> colors(map.has_color() ? points.size : 0);
  for (std::size_t slot = 0; slot < points.size; ++slot) {
    const std::uint32_t i = points.original_index[slot];
    cloud.positions[i] = points.offset(slot);
    if (map.has_color()) colors[i] = to_rgb8(color_at(map.colors, slot));
  }
  if (map.has_color()) cloud.colors = std::move(colors);
  return cloud;
}

/// A field in the map's own order from a value for every slot.
template <class ValueAt>
Array<float> field(const PointBlocks& points, ValueAt&& value_at) {
  Array<float> values(points.size);
  for (std::size_t slot = 0; slot < points.size; ++slot) {
    values[points.original_index[slot]] = static_cast<float>(value_at(slot));
  }
  return values;
}

void write_errors(const Evaluation& evaluation, const NearestPairs& pairs, const LocalColorRecall* recall,
                  OutputFile& file) {
  const PointBlocks& points = pairs.from.index.points;
  const Array<float> distances = field(points, [&](std::size_t slot) { return pairs.distance_m(slot); });
  std::vector<PointField> fields{{"scalar_distance_m", distances}};
  Array<float> color_distances, recall_classes;
  if (evaluation.pair.has_color()) {
    color_distances = field(points, [&](std::size_t slot) { return pairs.color_distance(slot); });
    fields.push_back({"scalar_color_distance", color_distances});
  }
  if (recall != nullptr) {
    recall_classes = field(points, [&](std::size_t slot) { return static_cast<int>(recall->classes[slot]); });
    fields.push_back({"scalar_lcr", recall_classes});
  }
  write_ply(file, point_cloud(pairs.from), fields);
}

}  // namespace

void write_estimate_errors(const Evaluation& evaluation, OutputFile& file) {
  write_errors(evaluation, evaluation.pair.estimate_to_reference(), nullptr, file);
}

void write_reference_errors(const Evaluation& evaluation, OutputFile& file) {
  write_errors(evaluation, evaluation.pair.reference_to_estimate(), evaluation.recall ? &*evaluation.recall : nullptr,
               file);
}

}  // namespace cmap
