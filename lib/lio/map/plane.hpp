#pragma once

#include <Eigen/Core>
#include <optional>

namespace cmap {

/// Sums over measured points, from which their plane follows.
struct PointSums {
  double n = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();                      ///< about the place that the user says
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;  ///< about the same
  double variance = 0.0;                                              ///< of the points' measurements, m^2

  void add(const Eigen::Vector3d& p, double point_variance_m2) {
    n += 1.0;
    sum += p;
    xx += p.x() * p.x();
    xy += p.x() * p.y();
    xz += p.x() * p.z();
    yy += p.y() * p.y();
    yz += p.y() * p.z();
    zz += p.z() * p.z();
    variance += point_variance_m2;
  }
};

/// A piece of a plane, with what it is uncertain by.
struct Plane {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< mean of its points, world, m
  /// Orthonormal; points spread most along long_axis.
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ(), long_axis = Eigen::Vector3f::UnitX(),
                  short_axis = Eigen::Vector3f::UnitY();
  float long_variance = 0.0f, short_variance = 0.0f;  ///< of the points along the axes, m^2
  /// Of the plane's offset at its center, m^2, and of its slopes along the axes (rad^2).
  float offset_variance = 0.0f, long_slope_variance = 0.0f, short_slope_variance = 0.0f;

  /// Signed, along the normal.
  double distance_m(const Eigen::Vector3d& p) const { return normal.cast<double>().dot(p - center); }
  /// Variance of the plane's own place beside a point.
  double variance_at(const Eigen::Vector3f& from_center) const {
    const float u = long_axis.dot(from_center), v = short_axis.dot(from_center);
    return static_cast<double>(offset_variance + u * u * long_slope_variance + v * v * short_slope_variance);
  }
};

struct PlaneRule {
  double least_points = 6.0;
  double most_thickness_m = 0.05;  ///< standard deviation across
  /// The points' spread across is at most this share of the cell, and of their spread along the shorter axis.
  double most_cell_share = 0.1, most_spread_share = 0.4;
  /// Least standard deviation along the shorter axis, above the noise of ranges: one ring on the ground, seen again and
  /// again, is a line as thick as that, and its plane goes through the beam, not along the ground.
  double least_spread_m = 0.06;
};

/// The plane of points about `origin` in a cell of that size; none where they are few or do not lie in one.
///
/// Center and axes are the points' mean and principal axes. Its uncertainty follows from theirs to first order (Liu and
/// Zhang 2021, Yuan et al. 2022): with s^2 the larger of the mean measurement variance and the variance across, that of
/// the offset is s^2 / n and that of the slope along an axis of variance l is s^2 / (n l).
std::optional<Plane> fit_plane(const PointSums& sums, const Eigen::Vector3d& origin, double cell_m,
                               const PlaneRule& rule);

}  // namespace cmap
