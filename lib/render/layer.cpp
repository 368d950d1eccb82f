#include "cmap/render/layer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/core/round_number.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/geometry/color.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/metrics/color_consistency.hpp"
#include "cmap/metrics/color_gaussians.hpp"
#include "cmap/metrics/wasserstein.hpp"

namespace cmap {
namespace {

/// A color for every slot.
template <class ColorAt>
Array<Rgb8> painted(std::size_t n, ColorAt&& color_at_slot) {
  Array<Rgb8> colors(n);
  parallel_chunks(n, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) colors[slot] = color_at_slot(slot);
  });
  return colors;
}

/// Of the values that are there; 0 without any.
double percentile(Array<float> values, double share) {
  std::erase_if(values, [](float v) { return std::isnan(v); });
  if (values.empty()) return 0.0;
  return value_at_rank(values, static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

ColorScale scale_for(const Array<float>& values, ColorMap map, std::string unit, const LayerOptions& options) {
  ColorScale scale;
  scale.map = options.color_map.value_or(map);
  scale.unit = std::move(unit);
  scale.logarithmic = options.logarithmic;
  if (options.range) {
    scale.low = (*options.range)[0];
    scale.high = (*options.range)[1];
  } else {
    constexpr double kShown = 0.95;      // the worst few may be anything
    constexpr double kDecades = 1000.0;  // on a logarithmic scale
    scale.high = round_number_above(percentile(values, kShown));
    scale.low = scale.logarithmic ? scale.high / kDecades : 0.0;
  }
  return scale;
}

template <class ValueAt>
Layer heat_map(const PointBlocks& points, std::string title, ColorMap map, std::string unit,
               const LayerOptions& options, ValueAt&& value_at) {
  Array<float> values(points.size);
  parallel_chunks(points.size, kLoopChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) values[slot] = static_cast<float>(value_at(slot));
  });
  Layer layer;
  layer.title = std::move(title);
  layer.points = &points;
  layer.scale = scale_for(values, map, std::move(unit), options);
  layer.colors =
      painted(points.size, [&](std::size_t slot) { return color_of(static_cast<double>(values[slot]), *layer.scale); });
  return layer;
}

/// Values of voxels by their world index, painted onto the points in them; points elsewhere have no value.
class VoxelValues {
 public:
  VoxelValues(const IndexedMap& map, double voxel_m) : frame_(map.index.bounds(), voxel_m) {}

  void set(const std::array<std::int64_t, 3>& index, double value) { values_[frame_.key(index)] = value; }

  double at(const Eigen::Vector3d& world) const {
    const double* value = values_.find(frame_.key(world));
    return value == nullptr ? std::numeric_limits<double>::quiet_NaN() : *value;
  }

 private:
  VoxelFrame frame_;
  VoxelMap<double> values_;
};

Layer voxel_layer(const IndexedMap& map, std::string title, ColorMap color_map, std::string unit,
                  const LayerOptions& options, const VoxelValues& voxels) {
  const PointBlocks& points = map.index.points;
  return heat_map(points, std::move(title), color_map, std::move(unit), options,
                  [&](std::size_t slot) { return voxels.at(points.world(slot)); });
}

Layer consistency_layer(const EvaluatedPair& evaluation, const LayerOptions& options) {
  const IndexedMap& map = evaluation.pair.estimate;
  if (!map.has_color()) throw UnsupportedError("layer ccs: the estimate needs color");
  const MetricOptions& o = evaluation.options;
  const double voxel_m = o.ccs_voxel_m;
  VoxelValues voxels(map, voxel_m);
  for (const VoxelColors& voxel : voxel_colors(map, voxel_m)) {
    if (is_in_mean(voxel, o.ccs_singletons, o.ccs_min_points)) voxels.set(voxel.index, voxel.trace);
  }
  return voxel_layer(map, fmt::format("Color spread in voxels of {} m", voxel_m), ColorMap::kInferno, "unit RGB²",
                     options, voxels);
}

Layer wasserstein_layer(const EvaluatedPair& evaluation, const LayerOptions& options) {
  const double voxel_m = evaluation.options.awd_voxel_m;
  VoxelValues voxels(evaluation.pair.estimate, voxel_m);
  const PhaseOptions grid{.voxel_m = voxel_m, .min_points = evaluation.options.awd_min_points};
  const VoxelWasserstein found = voxel_wasserstein(evaluation.pair, grid);
  for (const auto& [index, distance_m] : found.by_phase.front()) {
    voxels.set(index, distance_m);
  }
  return voxel_layer(evaluation.pair.estimate, fmt::format("Wasserstein distance in voxels of {} m", voxel_m),
                     ColorMap::kViridis, "m", options, voxels);
}

Layer density_layer(const EvaluatedPair& evaluation, const LayerOptions& options) {
  const IndexedMap& map = evaluation.pair.estimate;
  const PointBlocks& points = map.index.points;
  const double voxel_m = evaluation.options.ccs_voxel_m;
  const VoxelFrame frame(map.index.bounds(), voxel_m);
  VoxelMap<std::uint32_t> counts;
  for (std::size_t slot = 0; slot < points.size; ++slot) ++counts[frame.key(points.world(slot))];
  return heat_map(points, fmt::format("Points in voxels of {} m", voxel_m), ColorMap::kViridis, "", options,
                  [&](std::size_t slot) { return *counts.find(frame.key(points.world(slot))); });
}

Layer height_layer(const IndexedMap& map, std::string title, const LayerOptions& options) {
  const PointBlocks& points = map.index.points;
  Array<float> heights(points.size);
  for (std::size_t slot = 0; slot < points.size; ++slot) heights[slot] = static_cast<float>(points.world(slot).z());
  LayerOptions between = options;
  if (!between.range) {
    const double low = percentile(heights, 0.01), high = percentile(heights, 0.99);
    between.range = {low, high > low ? high : low + 1.0};
  }
  return heat_map(points, std::move(title), ColorMap::kViridis, "m", between,
                  [&](std::size_t slot) { return heights[slot]; });
}

Layer color_layer(const IndexedMap& map, std::string title) {
  Layer layer;
  layer.title = std::move(title);
  layer.points = &map.index.points;
  layer.colors = painted(map.size(), [&](std::size_t slot) { return to_rgb8(color_at(map.colors, slot)); });
  return layer;
}

Layer recall_layer(const EvaluatedPair& evaluation) {
  if (!evaluation.recall) {
    throw UnsupportedError("layer lcr: local color recall was not computed; it needs color in both maps");
  }
  Layer layer;
  layer.title = "Local color recall";
  layer.points = &evaluation.pair.reference.index.points;
  const auto add_class = [&](RecallClass c) {
    layer.classes.push_back({std::string(look_of(c).label), look_of(c).color});
  };
  for (RecallClass c : {RecallClass::kRecalled, RecallClass::kWrongColor, RecallClass::kNotCovered}) add_class(c);
  if (evaluation.pair.reference.n_without_color > 0) add_class(RecallClass::kNoColor);
  layer.colors =
      painted(layer.points->size, [&](std::size_t slot) { return look_of(evaluation.recall->classes[slot]).color; });
  return layer;
}

std::string caption_of(const EvaluatedPair& evaluation, std::string_view metric) {
  const Record* record = evaluation.metrics.find(metric);
  if (record == nullptr || !std::isfinite(record->value.value_or(NAN))) return "";
  const double value = *record->value;
  const MetricInfo& info = *find_metric(metric);
  if (info.id == "local_color_recall") return fmt::format("{} {:.1f} %", info.symbol, 100.0 * value);
  return fmt::format("{} {:.4g}{}", info.symbol, value, info.unit == "1" ? "" : fmt::format(" {}", info.unit));
}

void require_color(const EvaluatedPair& evaluation, std::string_view layer) {
  if (!evaluation.pair.has_color()) throw UnsupportedError(fmt::format("layer {}: both maps need color", layer));
}

Layer distance_layer(const EvaluatedPair& evaluation, const LayerOptions& options) {
  const NearestPairs pairs = evaluation.pair.estimate_to_reference();
  return heat_map(pairs.from.index.points, "Distance to the reference", ColorMap::kViridis, "m", options,
                  [&](std::size_t slot) { return pairs.distance_m(slot); });
}

Layer color_distance_layer(const EvaluatedPair& evaluation, const LayerOptions& options) {
  require_color(evaluation, "color-distance");
  const NearestPairs pairs = evaluation.pair.estimate_to_reference();
  return heat_map(pairs.from.index.points, "Color distance", ColorMap::kInferno, "unit RGB", options,
                  [&](std::size_t slot) { return pairs.color_distance(slot); });
}

Layer color_wasserstein_layer(const EvaluatedPair& evaluation, const LayerOptions& options) {
  require_color(evaluation, "color-wasserstein");
  const EvaluationOptions& o = evaluation.options;
  VoxelValues voxels(evaluation.pair.estimate, o.cw_voxel_m);
  const PhaseOptions grid{.voxel_m = o.cw_voxel_m, .min_points = o.cw_min_points};
  const ColorWasserstein found = color_wasserstein(evaluation.pair, grid);
  for (const ColoredVoxel& voxel : found.voxels) {
    voxels.set(voxel.index, voxel.distance);
  }
  return voxel_layer(evaluation.pair.estimate, fmt::format("Color Wasserstein in voxels of {} m", o.cw_voxel_m),
                     ColorMap::kInferno, "unit RGB", options, voxels);
}

Layer delta_e_layer(const EvaluatedPair& evaluation, const LayerOptions& options) {
  require_color(evaluation, "delta-e");
  const NearestPairs pairs = evaluation.pair.estimate_to_reference();
  return heat_map(pairs.from.index.points, "CIEDE2000", ColorMap::kInferno, "", options,
                  [&](std::size_t slot) { return pairs.delta_e(slot); });
}

Layer layer_of(const EvaluatedPair& evaluation, std::string_view name, const LayerOptions& options) {
  if (name == "reference") return make_layer(evaluation.pair.reference, "Reference", options);
  if (name == "estimate") return make_layer(evaluation.pair.estimate, "Estimate", options);
  if (name == "lcr") return recall_layer(evaluation);
  if (name == "color-distance") return color_distance_layer(evaluation, options);
  if (name == "distance") return distance_layer(evaluation, options);
  if (name == "delta-e") return delta_e_layer(evaluation, options);
  if (name == "ccs") return consistency_layer(evaluation, options);
  if (name == "color-wasserstein") return color_wasserstein_layer(evaluation, options);
  if (name == "wasserstein") return wasserstein_layer(evaluation, options);
  if (name == "density") return density_layer(evaluation, options);
  return height_layer(evaluation.pair.estimate, "Height", options);
}

}  // namespace

const std::vector<std::string>& layer_names() {
  static const std::vector<std::string> names{"reference",   "estimate", "lcr",   "color-distance",
                                              "distance",    "delta-e",  "ccs",   "color-wasserstein",
                                              "wasserstein", "density",  "height"};
  return names;
}

void check_layer_name(std::string_view name) {
  const std::vector<std::string>& known = layer_names();
  if (std::ranges::find(known, name) != known.end()) return;
  throw UsageError(
      fmt::format("layer \"{}\" is unknown{}; layers are {}", name, did_you_mean(name, known), fmt::join(known, ", ")));
}

std::string_view metric_of_layer(std::string_view name) {
  if (name == "lcr") return "local_color_recall";
  if (name == "color-distance") return "color_distance";
  if (name == "distance") return "chamfer";
  if (name == "delta-e") return "delta_e";
  if (name == "ccs") return "color_consistency";
  if (name == "color-wasserstein") return "color_wasserstein";
  if (name == "wasserstein") return "average_wasserstein";
  return "";
}

Layer make_layer(const EvaluatedPair& evaluation, std::string_view name, const LayerOptions& options) {
  check_layer_name(name);
  Layer layer = layer_of(evaluation, name, options);
  layer.caption = caption_of(evaluation, metric_of_layer(name));
  return layer;
}

Layer make_layer(const IndexedMap& map, const std::string& title, const LayerOptions& options) {
  return map.has_color() ? color_layer(map, title) : height_layer(map, title + " (height)", options);
}

}  // namespace cmap
