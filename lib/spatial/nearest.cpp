#include "cmap/spatial/nearest.hpp"

#include "cmap/core/parallel.hpp"
#include "simd/kernels.hpp"

namespace cmap {
namespace {
/// Small chunks, as queries far from everything cluster.
constexpr std::size_t kQueryChunk = 256;
}  // namespace

NearestField find_nearest(const Bvh& index, const PointBlocks& queries) {
  NearestField field{Array<std::uint32_t>(queries.size), Array<double>(queries.size)};
  const Queries moved{queries, queries.origin - index.points.origin};
  parallel_chunks(queries.blocks.size(), kQueryChunk,
                  [&](std::size_t begin, std::size_t end) { kernels().nearest(index, moved, begin, end, field); });
  return field;
}

NearestField find_nearest(IndexKind kind, const Bvh& index, const PointBlocks& queries) {
  return kind == IndexKind::kFlann ? find_nearest_flann(index.points, queries) : find_nearest(index, queries);
}

NearestNeighbors nearest_neighbors(const PointCloud& data, const PointCloud& queries) {
  const Bvh index(sort_points(data));
  const PointBlocks sorted_queries = sort_points(queries);
  const NearestField field = find_nearest(index, sorted_queries);
  NearestNeighbors neighbors{in_original_order(sorted_queries, field.slot),
                             in_original_order(sorted_queries, field.sq_dist)};
  for (std::uint32_t& i : neighbors.index) i = index.points.original_index[i];
  return neighbors;
}

}  // namespace cmap
