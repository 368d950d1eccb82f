#pragma once

#include <cstddef>
#include <cstdint>

#include "cmap/core/simd.hpp"
#include "cmap/spatial/bvh.hpp"
#include "cmap/spatial/k_nearest.hpp"
#include "cmap/spatial/nearest.hpp"
#include "cmap/spatial/radius.hpp"
#include "cmap/spatial/threshold.hpp"

namespace cmap {

/// Query points and the vector that moves them into the index's frame.
struct Queries {
  const PointBlocks& points;
  Eigen::Vector3d shift;
};

struct ColoredIndex {
  const Bvh& index;
  const Array<ColorBlock>& colors;
  const BoxLevels& color_boxes;
};

struct ColorQueries {
  const Queries& queries;
  const Array<ColorBlock>& colors;
  const NearestField& nearest;
};

/// Bits of the original index below the Hilbert key in a sort key.
inline constexpr int kIndexBits = 31;
inline constexpr int kCellBits = 11;

/// A grid of 2048 cells an axis over a box.
struct CurveGrid {
  float min[3];
  float cells_per_m[3];
};

/// One set of kernels for each instruction set, all with bitwise equal results. Every function handles the query
/// blocks [begin, end) and writes only their slots.
struct Kernels {
  /// keys[i] = Hilbert cell of positions[i] << 31 | first_index + i.
  void (*hilbert_keys)(const Eigen::Vector3f* positions, std::size_t n, const CurveGrid& grid,
                       std::uint64_t first_index, std::uint64_t* keys);
  void (*nearest)(const Bvh& index, const Queries& queries, std::size_t begin, std::size_t end, NearestField& result);
  /// k slots for each query slot.
  void (*k_nearest)(const Bvh& index, const Queries& queries, std::size_t k, std::size_t begin, std::size_t end,
                    std::uint32_t* slots);
  void (*most_similar_color)(const ColoredIndex& target, const ColorQueries& queries, const ColorSearch& search,
                             std::size_t begin, std::size_t end, Array<float>& best);
  void (*neighborhood_shapes)(const Bvh& cloud, double radius_m, double file_step_m, std::size_t begin, std::size_t end,
                              NeighborhoodShape& result);
};

/// The kernels of one level; `kernels()` are those of simd_level(). The level must be one this processor has.
const Kernels& kernels_for(SimdLevel level);
const Kernels& kernels();

}  // namespace cmap
