#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/eval/evaluation.hpp"

namespace cmap {

enum class ColorMap { kViridis, kCividis, kInferno, kTurbo };

/// Throws UsageError on an unknown name.
ColorMap color_map_from_name(std::string_view name);

/// 256 colors from low to high.
const std::array<Rgb8, 256>& color_table(ColorMap map);

/// How values become colors: linear or logarithmic between two ends, beyond them the color of the end.
struct ColorScale {
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;
  ColorMap map = ColorMap::kViridis;
  std::string unit;  ///< empty for a number without one
};

/// The color of a value; NaN is gray.
Rgb8 color_of(double value, const ColorScale& scale);

struct ColorClass {
  std::string label;
  Rgb8 color;
};

/// One way to color the points of a map, and what its colors mean.
struct Layer {
  std::string title;
  std::string caption;  ///< the metric's value
  const PointBlocks* points = nullptr;
  Array<Rgb8> colors;               ///< by slot of `points`
  std::optional<ColorScale> scale;  ///< of heat maps
  std::vector<ColorClass> classes;  ///< of class maps
  bool is_heat_map() const { return scale.has_value() || !classes.empty(); }
};

/// What a user may fix about a layer.
struct LayerOptions {
  std::optional<std::array<double, 2>> range;
  std::optional<ColorMap> color_map;
  bool logarithmic = false;
};

/// Names: reference and estimate (their own colors), lcr, color-distance, distance, delta-e, ccs,
/// color-wasserstein, wasserstein and density (by voxel), height.
const std::vector<std::string>& layer_names();

/// Throws UsageError on an unknown name.
void check_layer_name(std::string_view name);

/// The metric whose value a layer's caption shows, as an id of the catalog; empty where there is none.
std::string_view metric_of_layer(std::string_view name);

/// The layer of an evaluated pair; `lcr` is of the reference, all others but `reference` of the estimate. Throws
/// UsageError on an unknown name, UnsupportedError where the data cannot give it (no color; LCR was not computed).
Layer make_layer(const EvaluatedPair& evaluation, std::string_view name, const LayerOptions& options = {});

/// A map's own colors, or its height where it has none.
Layer make_layer(const IndexedMap& map, const std::string& title, const LayerOptions& options = {});

}  // namespace cmap
