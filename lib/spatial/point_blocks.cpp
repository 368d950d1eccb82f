#include "cmap/spatial/point_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/color.hpp"
#include "cmap/geometry/point_extent.hpp"
#include "cmap/spatial/radix_sort.hpp"
#include "simd/kernels.hpp"

namespace cmap {
namespace {

constexpr std::uint64_t kIndexMask = (std::uint64_t{1} << kIndexBits) - 1;
/// Points in one cell of the curve from which the cell gets a finer curve of its own.
constexpr std::size_t kCrowded = 2048;

/// So many slots early a point is asked for: neighbors on the curve are anywhere in the cloud.
constexpr std::size_t kAhead = 64;

struct Box3f {
  Eigen::Vector3f min = Eigen::Vector3f::Constant(INFINITY);
  Eigen::Vector3f max = Eigen::Vector3f::Constant(-INFINITY);
  Box3f& operator+=(const Box3f& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
    return *this;
  }
};

Box3f box_of(std::span<const Eigen::Vector3f> positions) {
  return ordered_sum<Box3f>(positions.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    const PointExtent<float> extent = point_extent(positions[begin].data(), end - begin);
    return Box3f{Eigen::Vector3f(extent.min.data()), Eigen::Vector3f(extent.max.data())};
  });
}

/// Cubic cells, so that the curve's neighborhoods are round.
CurveGrid grid_over(const Box3f& box) {
  const float extent = (box.max - box.min).maxCoeff();
  const float cells_per_m = extent > 0.0f ? static_cast<float>(1 << kCellBits) / extent : 0.0f;
  CurveGrid grid{};
  for (int a = 0; a < 3; ++a) {
    grid.min[a] = box.min[a];
    grid.cells_per_m[a] = cells_per_m;
  }
  return grid;
}

/// Indices of the positions along the curve over `box`, in the low bits of the sorted keys.
Array<std::uint64_t> sorted_keys(std::span<const Eigen::Vector3f> positions, const Box3f& box) {
  Array<std::uint64_t> keys(positions.size());
  const CurveGrid grid = grid_over(box);
  parallel_chunks(positions.size(), kLoopChunk, [&](std::size_t begin, std::size_t end) {
    kernels().hilbert_keys(positions.data() + begin, end - begin, grid, begin, keys.data() + begin);
  });
  Array<std::uint64_t> scratch;
  radix_sort(keys, scratch, kIndexBits, 64);
  return keys;
}

/// Orders the points of one crowded cell, order[i] & kIndexMask, along a curve over their own box; recursive, as a few
/// far outliers or several distant clusters leave the first curve few cells where the points are.
void refine_cell(std::span<const Eigen::Vector3f> positions, std::span<std::uint64_t> order) {
  Array<Eigen::Vector3f> members(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) members[i] = positions[order[i] & kIndexMask];
  const Box3f box = box_of(members);
  if (!(box.max - box.min).any()) return;  // all in one place: the order of the file is kept

  const Array<std::uint64_t> keys = sorted_keys(members, box);
  Array<std::uint64_t> reordered(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    reordered[i] = (keys[i] & ~kIndexMask) | (order[keys[i] & kIndexMask] & kIndexMask);
  }
  std::copy(reordered.begin(), reordered.end(), order.begin());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && order[end] >> kIndexBits == order[begin] >> kIndexBits) ++end;
    if (end - begin > kCrowded && end - begin < order.size()) refine_cell(positions, order.subspan(begin, end - begin));
  }
}

void refine_crowded_cells(std::span<const Eigen::Vector3f> positions, Array<std::uint64_t>& order) {
  const std::size_t n = order.size();
  const auto cell = [&](std::size_t i) { return order[i] >> kIndexBits; };
  std::size_t begin = 0;
  // A crowded cell covers a multiple of kCrowded / 2, so only those places need a look.
  for (std::size_t probe = 0; probe < n; probe = std::max(probe, begin) + kCrowded / 2) {
    if (probe + kCrowded / 2 >= n || cell(probe) != cell(probe + kCrowded / 2)) continue;
    begin = probe;
    while (begin > 0 && cell(begin - 1) == cell(probe)) --begin;
    std::size_t end = probe;
    while (end < n && cell(end) == cell(probe)) ++end;
    if (end - begin > kCrowded) refine_cell(positions, std::span(order).subspan(begin, end - begin));
    begin = end - std::min(end, kCrowded / 2);
  }
}

void fill_block(const PointCloud& cloud, const Array<std::uint64_t>& order, std::size_t block, PointBlocks& sorted) {
  for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
    const std::size_t later = std::min(block * kBlockSize + lane + kAhead, order.size() - 1);
    __builtin_prefetch(&cloud.positions[order[later] & kIndexMask]);
    const std::size_t slot = std::min(block * kBlockSize + lane, order.size() - 1);
    const auto index = static_cast<std::uint32_t>(order[slot] & kIndexMask);
    const Eigen::Vector3f& p = cloud.positions[index];
    sorted.blocks[block].x[lane] = p.x();
    sorted.blocks[block].y[lane] = p.y();
    sorted.blocks[block].z[lane] = p.z();
    sorted.original_index[block * kBlockSize + lane] = index;
  }
}

template <class Color>
void fill_colors(const Array<Color>& values, const PointBlocks& points, std::size_t block, ColorBlock& sorted) {
  const std::size_t last = points.original_index.size() - 1;
  for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
    const std::size_t slot = block * kBlockSize + lane;
    __builtin_prefetch(&values[points.original_index[std::min(slot + kAhead, last)]]);
    const RgbF color = rgb_255(values[points.original_index[slot]]);
    sorted.r[lane] = color[0];
    sorted.g[lane] = color[1];
    sorted.b[lane] = color[2];
  }
}

}  // namespace

PointBlocks sort_points(const PointCloud& cloud) {
  const std::size_t n = cloud.size();
  if (n == 0) throw std::invalid_argument("sort_points: empty point cloud");
  if (n > kIndexMask) throw UnsupportedError(fmt::format("{} points: at most {} are supported", n, kIndexMask));
  const std::span<const Eigen::Vector3f> positions(cloud.positions);
  Array<std::uint64_t> order = sorted_keys(positions, box_of(positions));
  refine_crowded_cells(positions, order);

  PointBlocks sorted;
  sorted.origin = cloud.origin;
  sorted.size = n;
  sorted.blocks.resize((n + kBlockSize - 1) / kBlockSize);
  sorted.original_index.resize(sorted.blocks.size() * kBlockSize);
  parallel_chunks(sorted.blocks.size(), kLoopChunk / kBlockSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) fill_block(cloud, order, block, sorted);
  });
  return sorted;
}

PointBlocks chosen_points(const PointBlocks& points, const Array<std::uint32_t>& slots) {
  PointBlocks chosen;
  chosen.origin = points.origin;
  chosen.size = slots.size();
  chosen.blocks.resize((slots.size() + kBlockSize - 1) / kBlockSize);
  for (std::size_t i = 0; i < chosen.blocks.size() * kBlockSize; ++i) {
    const Eigen::Vector3f p = points.offset(slots[std::min(i, slots.size() - 1)]);
    PointBlock& block = chosen.blocks[i / kBlockSize];
    block.x[i % kBlockSize] = p.x();
    block.y[i % kBlockSize] = p.y();
    block.z[i % kBlockSize] = p.z();
  }
  return chosen;
}

Array<ColorBlock> sort_colors(const PointCloud& cloud, const PointBlocks& points) {
  Array<ColorBlock> colors(points.blocks.size());
  const auto fill_all = [&]<class T>(const T& values) {
    if constexpr (!std::is_same_v<T, std::monostate>) {
      parallel_chunks(colors.size(), kLoopChunk / kBlockSize, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) fill_colors(values, points, block, colors[block]);
      });
    }
  };
  std::visit(fill_all, cloud.colors);
  return colors;
}

}  // namespace cmap
