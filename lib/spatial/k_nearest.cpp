#include "cmap/spatial/k_nearest.hpp"

#include <stdexcept>

#include "cmap/core/parallel.hpp"
#include "simd/kernels.hpp"

namespace cmap {

Array<std::uint32_t> find_k_nearest(const Bvh& index, const PointBlocks& queries, std::size_t k) {
  constexpr std::size_t kSeveralNearestChunk = 64;
  constexpr std::size_t kMostNeighbors = 64;
  if (k < 1 || k > kMostNeighbors) throw std::invalid_argument("find_k_nearest: k must be 1 to 64");
  Array<std::uint32_t> slots(queries.size * k);
  const Queries moved{queries, queries.origin - index.points.origin};
  parallel_chunks(queries.blocks.size(), kSeveralNearestChunk, [&](std::size_t begin, std::size_t end) {
    kernels().k_nearest(index, moved, k, begin, end, slots.data());
  });
  return slots;
}

}  // namespace cmap
