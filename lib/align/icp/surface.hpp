#pragma once

#include <Eigen/Core>

#include "cmap/spatial/bvh.hpp"

namespace cmap {

/// Local planes through a cloud's points, by slot, fitted where they are asked for: registrations match a part of a
/// target's points, and fitting costs more than all their iterations.
class Surface {
 public:
  /// Planes are fitted to the k nearest points of `cloud`, the point itself included; it must outlive the surface.
  Surface(const Bvh& cloud, std::size_t k);

  /// Fits the planes at these slots that are not known yet. Not thread-safe; runs in parallel.
  void fit(const Array<std::uint32_t>& slots);
  void fit_all();

  /// Unit normal of either sign: the direction in which the neighbors spread least. Zero where they lie in one place or
  /// along a line, as do neighbors on one scan line of a LiDAR. The slot must have been fitted.
  Eigen::Vector3d normal(std::size_t slot) const { return normals_[slot].cast<double>(); }
  /// Variance by which noise of the points tilts the normal, rad^2: that of a least-squares plane, in its less certain
  /// direction.
  double tilt_variance(std::size_t slot) const { return static_cast<double>(tilt_variance_[slot]); }

 private:
  const Bvh& cloud_;
  std::size_t k_;
  Array<Eigen::Vector3f> normals_;
  Array<float> tilt_variance_;
  Array<std::uint8_t> is_known_;
};

}  // namespace cmap
