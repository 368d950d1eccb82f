#pragma once

#include <cstdint>
#include <string_view>

#include "cmap/spatial/bvh.hpp"

namespace cmap {

/// The nearest point of an index for every query, by the query's slot.
struct NearestField {
  Array<std::uint32_t> slot;  ///< slot of the nearest point in the index's PointBlocks
  Array<double> sq_dist;      ///< squared distance in m^2, computed in double from the stored offsets
};

enum class IndexKind { kBvh, kFlann };

/// Exact nearest neighbors without a distance limit, decided by the squared distance (dx dx + dy dy) + dz dz in double
/// of the stored offsets; among equally near points the lowest original index wins. The result is bitwise the same for
/// any number of threads and every instruction set. Clouds with different origins are compared after moving the queries
/// by the difference, rounded to float.
NearestField find_nearest(const Bvh& index, const PointBlocks& queries);

/// The same through FLANN's exact kd-tree: the second opinion. Ties are FLANN's choice.
NearestField find_nearest_flann(const PointBlocks& index, const PointBlocks& queries);

/// Either, by kind.
NearestField find_nearest(IndexKind kind, const Bvh& index, const PointBlocks& queries);

/// Nearest neighbors in the clouds' own order, for a single use: sorts both, builds, searches.
struct NearestNeighbors {
  Array<std::uint32_t> index;  ///< into `data`
  Array<double> sq_dist;       ///< m^2
};
NearestNeighbors nearest_neighbors(const PointCloud& data, const PointCloud& queries);

}  // namespace cmap
