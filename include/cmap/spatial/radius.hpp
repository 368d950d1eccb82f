#pragma once

#include <cstdint>

#include "cmap/spatial/bvh.hpp"

namespace cmap {

/// Search for the most similar color within a radius, the core of local color recall.
struct ColorSearch {
  double radius_m = 0.5;
  /// A query is done as soon as its squared color distance (1/255 units) is at most this.
  float stop_at = 0.0f;
};

/// Lowers best[s], the squared RGB distance (1/255 units) of query slot s to its most similar color so far, by every
/// point of `index` within the radius; entries at or below `stop_at` on entry are left alone. The radius is decided in
/// double. Returns nothing else: seed `best` with the nearest neighbor's color distance, or an upper limit of interest.
void lower_color_distance(const Bvh& index, const Array<ColorBlock>& index_colors, const BoxLevels& index_color_boxes,
                          const PointBlocks& queries, const Array<ColorBlock>& query_colors, const ColorSearch& search,
                          Array<float>& best);

/// Number and covariance determinant of every point's neighbors within a radius, by slot.
struct NeighborhoodShape {
  Array<std::uint32_t> n_neighbors;  ///< the point itself left out; duplicates of it count
  /// m^6, n - 1 denominator; NaN for fewer than 2 neighbors, 0 for flat ones: not above 1e-14 (trace / 3)^3, where the
  /// sign would be rounding noise.
  Array<double> covariance_det;
};

/// Visits all neighbors at distance <= radius_m of every point, in double. Deterministic for any number of threads.
NeighborhoodShape neighborhood_shapes(const Bvh& cloud, double radius_m);

}  // namespace cmap
