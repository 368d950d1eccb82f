#include "cmap/eval/point_errors.hpp"

#include "cmap/io/point_cloud_file.hpp"

namespace cmap {
namespace {

/// A field in the map's own order from a value for every slot.
template <class ValueAt>
Array<float> field(const PointBlocks& points, ValueAt&& value_at) {
  Array<float> values(points.size);
  for (std::size_t slot = 0; slot < points.size; ++slot) {
    values[points.original_index[slot]] = static_cast<float>(value_at(slot));
  }
  return values;
}

void write_errors(const EvaluatedPair& evaluation, const NearestPairs& pairs, const LocalColorRecall* recall,
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
  write_ply(file, cloud_of(pairs.from), fields);
}

}  // namespace

void write_estimate_errors(const EvaluatedPair& evaluation, OutputFile& file) {
  write_errors(evaluation, evaluation.pair.estimate_to_reference(), nullptr, file);
}

void write_reference_errors(const EvaluatedPair& evaluation, OutputFile& file) {
  write_errors(evaluation, evaluation.pair.reference_to_estimate(), evaluation.recall ? &*evaluation.recall : nullptr,
               file);
}

}  // namespace cmap
