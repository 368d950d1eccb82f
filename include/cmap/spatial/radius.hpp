#pragma once

#include <cstdint>

#include "cmap/spatial/bvh.hpp"
#include "cmap/spatial/nearest.hpp"

namespace cmap {

/// Search for the most similar color within a radius, the core of local color recall. Color distances are squared RGB
/// distances in units of 1/255.
struct ColorSearch {
  double radius_m = 0.5;
  /// A query is done as soon as its color distance is at most this.
  float stop_at = 0.0f;
  /// Only smaller color distances are looked for; this stands for all others.
  float unless_below = 0.0f;
  /// Float steps at the points' offsets by which a distance may exceed the radius (spatial/threshold.hpp).
  double radius_steps = 0.0;
};

/// What stands for the color distance of a query without a point within the radius.
inline constexpr float kNoneWithin = -1.0f;

/// For every query slot the color distance to the most similar point of `index` within the radius, which is decided in
/// double; `nearest` are the queries' nearest points. Exact between `stop_at` and `unless_below`; a lower one is only
/// known to be at most `stop_at`. Deterministic for any number of threads.
Array<float> most_similar_color(const Bvh& index, const Array<ColorBlock>& index_colors, const PointBlocks& queries,
                                const Array<ColorBlock>& query_colors, const NearestField& nearest,
                                const ColorSearch& search);

/// Number and covariance of every point's neighbors within a radius, by slot.
struct NeighborhoodShape {
  Array<std::uint32_t> n_neighbors;  ///< the point itself left out; duplicates of it count
  /// m^6, n - 1 denominator; NaN for fewer than 2 neighbors, 0 for flat ones: not above 1e-14 (trace / 3)^3, where the
  /// sign would be rounding noise.
  Array<double> covariance_det;
  /// 1 where the neighbors are flat to the rounding of their coordinates: the covariance's smallest eigenvalue is below
  /// the square of the larger of float's step at the offsets within the radius and file_step_m, or its determinant is
  /// 0.
  Array<std::uint8_t> is_flat;
};

/// Visits all neighbors at distance <= radius_m of every point, in double; file_step_m is the step in which the file
/// held the coordinates, 0 where it is not known. Offsets and their products are summed in steps of 2^-64 of the power
/// of two above the radius, or its square, without error: deterministic for any number of threads, and the same bits
/// for any order of the points and whatever lies beyond the radius.
NeighborhoodShape neighborhood_shapes(const Bvh& cloud, double radius_m, double file_step_m = 0.0);

}  // namespace cmap
