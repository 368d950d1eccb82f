#pragma once

#include <cstdint>

#include "cmap/spatial/bvh.hpp"

namespace cmap {

/// How close the points of one map stand: over its places, the distance from a place to the nearest other one. Points
/// of equal coordinates are one place, so that copies make a map no denser. NaN where all points are at one place.
struct PointSpacing {
  double median_m = 0.0;
  double mean_m = 0.0;
  std::uint64_t n = 0;         ///< places
  std::uint64_t n_copies = 0;  ///< points at a place that another point has taken
};

/// Exact; bitwise the same for any number of threads and every instruction set.
PointSpacing point_spacing(const Bvh& map);

}  // namespace cmap
