#pragma once

#include <cstdint>

#include "cmap/spatial/bvh.hpp"

namespace cmap {

/// Stands for a neighbor that does not exist, where the index has fewer than k points.
inline constexpr std::uint32_t kNoNeighbor = ~0u;

/// The k nearest points of the index for every query: slots of the index, nearest first, k for each query slot. Decided
/// like find_nearest(): squared distances in double of the stored offsets, ties to the lowest original index; a query
/// that is a point of the index finds itself. Bitwise the same for any number of threads and every instruction set.
/// Throws std::invalid_argument unless 1 <= k <= 64.
Array<std::uint32_t> find_k_nearest(const Bvh& index, const PointBlocks& queries, std::size_t k);

}  // namespace cmap
