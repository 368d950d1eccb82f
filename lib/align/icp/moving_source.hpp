#pragma once

#include "cmap/geometry/similarity.hpp"
#include "cmap/spatial/bvh.hpp"
#include "cmap/spatial/nearest.hpp"

namespace cmap {

/// Maps offsets from one cloud's origin to offsets from another's, as the transform maps world coordinates.
Similarity local_transform(const Similarity& T_dst_src, const Eigen::Vector3d& src_origin,
                           const Eigen::Vector3d& dst_origin);
/// The other way round.
Similarity world_transform(const Similarity& local, const Eigen::Vector3d& src_origin,
                           const Eigen::Vector3d& dst_origin);

/// A source that registrations move again and again: sorted once, as neighbors stay neighbors under similarities.
class MovingSource {
 public:
  explicit MovingSource(const PointCloud& cloud) : MovingSource(sort_points(cloud)) {}
  explicit MovingSource(PointBlocks sorted_points);

  std::size_t size() const { return points_.size; }
  const PointBlocks& points() const { return points_; }
  /// Center of the points, an offset from their origin, m.
  const Eigen::Vector3d& center() const { return center_; }

  /// The target's nearest point of every slot after the motion; `local` maps offsets to offsets from the target's
  /// origin.
  NearestField nearest(const Bvh& target, const Similarity& local);
  /// The slot's offset from the target's origin after the motion, in double.
  static Eigen::Vector3d moved(const Similarity& local, const PointBlocks& points, std::size_t slot) {
    return local * points.offset(slot).cast<double>();
  }

 private:
  PointBlocks points_;
  PointBlocks moved_;
  Eigen::Vector3d center_;
};

}  // namespace cmap
