#pragma once

#include "cmap/align/alignment.hpp"
#include "icp/information.hpp"
#include "icp/moving_source.hpp"
#include "icp/surface.hpp"

namespace cmap {

/// The cloud thinned to a voxel; 0: as it is. Throws std::invalid_argument where it is empty.
PointCloud thinned_to(const PointCloud& cloud, double voxel_m);

/// At most about `most` of n slots, evenly along the curve that they follow.
Array<std::uint32_t> every_few(std::size_t n, std::size_t most);

/// Of the points at some slots, the median distance to their nearest neighbor, m.
double median_spacing_m(const Bvh& index, const Array<std::uint32_t>& slots);

/// Targets are thinned to half the source's voxel: two lattices of one voxel lock into each other wherever they start,
/// which keeps shifts of half a voxel and scales of a few percent from being seen at all.
inline PointCloud thinned_target(const PointCloud& cloud, double voxel_m) { return thinned_to(cloud, 0.5 * voxel_m); }

/// A target with its surface.
struct RegistrationTarget {
  RegistrationTarget(const PointCloud& cloud, std::size_t neighbors)
      : index(sort_points(cloud)), surface(index, neighbors) {}
  RegistrationTarget(const RegistrationTarget&) = delete;
  RegistrationTarget& operator=(const RegistrationTarget&) = delete;

  /// Fits the surface at the matches.
  void fit_surface(const NearestField& field, double max_distance_m);

  Bvh index;
  Surface surface;
};

/// Fills overlap, RMSE, counts, condition, weakest direction and standard errors for the source at `local`. Throws
/// UnsupportedError where fewer than 3 points match, or where the surface leaves a direction free.
void assess(MovingSource& source, RegistrationTarget& target, const Similarity& local, double max_distance_m,
            bool with_scale, Alignment& result);

/// Throws the UnsupportedError of clouds that do not meet.
[[noreturn]] void fail_no_overlap(std::size_t n_matches, double max_distance_m);

/// Whether the step from one transform to the next is small enough to stop.
struct StepLimits {
  double rotation_rad, translation_m, scale;
  bool hold(const Similarity& before, const Similarity& after, const Eigen::Vector3d& center) const;
};

}  // namespace cmap
