#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "cmap/geometry/color.hpp"
#include "cmap/spatial/bvh.hpp"
#include "cmap/spatial/nearest.hpp"
#include "cmap/spatial/threshold.hpp"

namespace cmap {

/// Points of a cloud that have no color of their own though the cloud has colors: NaN.
inline std::uint64_t count_without_color(const Colors& colors) {
  const auto* values = std::get_if<Array<RgbF>>(&colors);
  if (values == nullptr) return 0;
  return static_cast<std::uint64_t>(std::ranges::count_if(*values, [](const RgbF& c) { return std::isnan(c[0]); }));
}

/// A map ready for evaluation: its index, and its colors in the index's slots (empty where it has none). A color of NaN
/// is none: the point counts for geometry and not for color.
struct IndexedMap {
  explicit IndexedMap(const PointCloud& cloud)
      : index(sort_points(cloud)),
        colors(cloud.has_color() ? sort_colors(cloud, index.points) : Array<ColorBlock>{}),
        n_without_color(count_without_color(cloud.colors)),
        has_8_bit_colors(std::holds_alternative<Array<Rgb8>>(cloud.colors)),
        largest_step_m(float_step(largest_offset(index))),
        file_step_m(cloud.file_step_m) {}

  std::size_t size() const { return index.points.size; }
  bool has_color() const { return !colors.empty(); }
  bool has_color_at(std::size_t slot) const { return n_without_color == 0 || !std::isnan(color_at(colors, slot).x()); }
  Eigen::Vector3d color(std::size_t slot) const { return color_at(colors, slot).cast<double>(); }

  Bvh index;
  Array<ColorBlock> colors;
  std::uint64_t n_without_color;  ///< points whose color is NaN
  bool has_8_bit_colors;
  double largest_step_m;  ///< float's step at the largest coordinate of any offset
  double file_step_m;     ///< the cloud's
};

/// The map in its own order; colors as 8 bit.
PointCloud cloud_of(const IndexedMap& map);

/// One direction of the comparison: every point of `from` with its nearest point of `to`.
struct NearestPairs {
  const IndexedMap& from;
  const IndexedMap& to;
  const NearestField& nearest;

  std::size_t size() const { return from.size(); }
  double distance_m(std::size_t slot) const { return std::sqrt(nearest.sq_dist[slot]); }

  /// Whether the pair's distance is at most a threshold, as METRICS means it (spatial/threshold.hpp).
  bool is_within(std::size_t slot, double threshold_m) const {
    const double d = distance_m(slot);
    return d <= threshold_m || (d <= threshold_m + most_rounding_m() && d <= threshold_m + rounding_m(slot));
  }
  /// How far above a threshold the pair's distance counts as at it, and how far that of any pair may.
  double rounding_m(std::size_t slot) const {
    const Eigen::Vector3f a = from.index.points.offset(slot), b = to.index.points.offset(nearest.slot[slot]);
    return kThresholdSteps * float_step(a.cwiseAbs().cwiseMax(b.cwiseAbs()).maxCoeff());
  }
  double most_rounding_m() const { return kThresholdSteps * std::max(from.largest_step_m, to.largest_step_m); }

  /// Whether both the point and its nearest neighbor have a color.
  bool has_colors(std::size_t slot) const { return from.has_color_at(slot) && to.has_color_at(nearest.slot[slot]); }
  /// Color of the point and of its nearest neighbor, RGB in units of 1/255.
  Eigen::Vector3d from_color(std::size_t slot) const { return from.color(slot); }
  Eigen::Vector3d to_color(std::size_t slot) const { return to.color(nearest.slot[slot]); }
  /// Difference of both colors after a gain per channel, in units of 1/255.
  Eigen::Vector3d color_difference(std::size_t slot, const Eigen::Vector3d& from_gain,
                                   const Eigen::Vector3d& to_gain) const {
    return from_color(slot).cwiseProduct(from_gain) - to_color(slot).cwiseProduct(to_gain);
  }
  /// Euclidean distance of both colors, unit RGB: 0 to sqrt(3); NaN where either has none.
  double color_distance(std::size_t slot) const { return (from_color(slot) - to_color(slot)).norm() / 255.0; }
  /// CIEDE2000 of both colors; NaN where either has none.
  double delta_e(std::size_t slot) const {
    return delta_e_2000(srgb_to_lab(from_color(slot) / 255.0), srgb_to_lab(to_color(slot) / 255.0));
  }
};

/// Both maps and both nearest-neighbor fields: what every metric reads.
struct MapPair {
  IndexedMap reference;
  IndexedMap estimate;
  NearestField nearest_in_reference;  ///< by estimate slot
  NearestField nearest_in_estimate;   ///< by reference slot

  NearestPairs estimate_to_reference() const { return {estimate, reference, nearest_in_reference}; }
  NearestPairs reference_to_estimate() const { return {reference, estimate, nearest_in_estimate}; }
  bool has_color() const { return reference.has_color() && estimate.has_color(); }
};

}  // namespace cmap
