#pragma once

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

/// Of n >= 1 points; four points at a time, so that the loop vectorizes.
template <class Real>
PointExtent<Real> point_extent(const Real* xyz, std::size_t n) {
  constexpr std::size_t kLanes = 12;
  Real low[kLanes], high[kLanes], not_finite[kLanes] = {};
  for (std::size_t j = 0; j < kLanes; ++j) low[j] = high[j] = xyz[j % 3];
  const auto add = [&](std::size_t j, Real value) {
    low[j] = value < low[j] ? value : low[j];
    high[j] = value > high[j] ? value : high[j];
    not_finite[j] += value * Real{0};  // NaN from then on if the value is NaN or infinite
  };
  std::size_t i = 0;
  for (; i + kLanes <= 3 * n; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; ++j) add(j, xyz[i + j]);
  }
  for (; i < 3 * n; ++i) add(i % 3, xyz[i]);
  PointExtent<Real> extent{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}, true};
  for (std::size_t j = 0; j < kLanes; ++j) {
    extent.min[j % 3] = std::min(extent.min[j % 3], low[j]);
    extent.max[j % 3] = std::max(extent.max[j % 3], high[j]);
    extent.finite = extent.finite && not_finite[j] == Real{0};
  }
  return extent;
}

}  // namespace cmap
