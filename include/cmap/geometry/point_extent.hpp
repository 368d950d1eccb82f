#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

namespace cmap {

/// The box of points, and whether all of them are finite: only then it is one.
template <class Real>
struct PointExtent {
  std::array<Real, 3> min, max;
  bool finite;
};

/// Of n >= 1 points; four points at a time, which are three vectors of four numbers.
template <class Real>
PointExtent<Real> point_extent(const Real* xyz, std::size_t n) {
  using Lanes = Eigen::Array<Real, 4, 1>;
  constexpr std::size_t kLanes = 4, kNumbers = 3 * kLanes;
  Lanes low[3], high[3], not_finite[3];
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      low[k][static_cast<Eigen::Index>(lane)] = xyz[(k * kLanes + lane) % 3];
    high[k] = low[k];
    not_finite[k].setZero();
  }
  std::size_t i = 0;
  for (; i + kNumbers <= 3 * n; i += kNumbers) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Lanes values = Eigen::Map<const Lanes>(xyz + i + k * kLanes);
      low[k] = low[k].min(values);
      high[k] = high[k].max(values);
      not_finite[k] += values * Real{0};  // NaN from then on if a value is NaN or infinite
    }
  }
  PointExtent<Real> extent{{xyz[0], xyz[1], xyz[2]}, {xyz[0], xyz[1], xyz[2]}, true};
  const auto add = [&](std::size_t axis, Real lowest, Real highest, Real zero) {
    extent.min[axis] = std::min(extent.min[axis], lowest);
    extent.max[axis] = std::max(extent.max[axis], highest);
    extent.finite = extent.finite && zero == Real{0};
  };
  for (std::size_t j = 0; j < kNumbers; ++j) {
    const std::size_t k = j / kLanes;
    const auto lane = static_cast<Eigen::Index>(j % kLanes);
    add(j % 3, low[k][lane], high[k][lane], not_finite[k][lane]);
  }
  for (; i < 3 * n; ++i) add(i % 3, xyz[i], xyz[i], xyz[i] * Real{0});
  return extent;
}

}  // namespace cmap
