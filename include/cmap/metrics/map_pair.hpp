#pragma once

#include <Eigen/Core>

#include "cmap/spatial/bvh.hpp"
#include "cmap/spatial/nearest.hpp"

namespace cmap {

/// A map ready for evaluation: its index, and its colors in the index's slots (empty where it has none).
struct IndexedMap {
  explicit IndexedMap(const PointCloud& cloud)
      : index(sort_points(cloud)), colors(cloud.has_color() ? sort_colors(cloud, index.points) : Array<ColorBlock>{}) {}

  std::size_t size() const { return index.points.size; }
  bool has_color() const { return !colors.empty(); }
  Eigen::Vector3d color(std::size_t slot) const { return color_at(colors, slot).cast<double>(); }

  Bvh index;
  Array<ColorBlock> colors;
};

/// One direction of the comparison: every point of `from` with its nearest point of `to`.
struct NearestPairs {
  const IndexedMap& from;
  const IndexedMap& to;
  const NearestField& nearest;

  std::size_t size() const { return from.size(); }
  double distance_m(std::size_t slot) const { return std::sqrt(nearest.sq_dist[slot]); }
  /// Color of the point and of its nearest neighbor, RGB in units of 1/255.
  Eigen::Vector3d from_color(std::size_t slot) const { return from.color(slot); }
  Eigen::Vector3d to_color(std::size_t slot) const { return to.color(nearest.slot[slot]); }
  /// Difference of both colors after a gain per channel, in units of 1/255.
  Eigen::Vector3d color_difference(std::size_t slot, const Eigen::Vector3d& from_gain,
                                   const Eigen::Vector3d& to_gain) const {
    return from_color(slot).cwiseProduct(from_gain) - to_color(slot).cwiseProduct(to_gain);
  }
  /// Euclidean distance of both colors, unit RGB: 0 to sqrt(3).
  double color_distance(std::size_t slot) const { return (from_color(slot) - to_color(slot)).norm() / 255.0; }
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
