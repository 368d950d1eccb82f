#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

struct SurfelOptions {
  int neighbors = 12;             ///< of each point, for its plane
  double least_radius_m = 0.03;   ///< of a disc
  double largest_radius_m = 0.5;  ///< a point without neighbors is no wall
};

/// Neighboring points, for leaving out many at once.
struct SurfelGroup {
  Eigen::Vector3f center;  ///< offset from the origin, m
  float radius_m = 0.0f;   ///< of a ball around their discs
};

/// The points of a map as discs that close its surfaces, along a Hilbert curve, in groups of kSurfelGroup. The normal
/// is that of the plane through a point's neighbors (the least axis of their covariance; its sign means nothing); the
/// radius is the mean distance of the four nearest, within the options' bounds: as wide as the map is coarse there.
struct Surfels {
  static constexpr std::size_t kGroup = 256;

  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< world, m
  Array<Eigen::Vector3f> positions;                  ///< offsets from the origin, m
  Array<Eigen::Vector3f> normals;                    ///< unit; of a point that has fewer than three others: zero
  Array<float> radius_m;
  Array<std::uint32_t> original_index;  ///< in the cloud
  std::vector<SurfelGroup> groups;      ///< group g holds slots g kGroup to (g + 1) kGroup

  std::size_t size() const { return positions.size(); }
};

/// Throws std::invalid_argument for an empty cloud. Thread-safe; the same for any number of threads.
Surfels surfels_of(const PointCloud& cloud, const SurfelOptions& options);

/// Median distance of a point to its nearest other one, of at most 10,000 of them: how fine a map is. 0 of one point.
double spacing_of(const PointCloud& cloud);

}  // namespace cmap
