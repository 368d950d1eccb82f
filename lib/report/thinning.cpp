#include "thinning.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cmap/core/parallel.hpp"
#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

/// About the surface that a block's points cover: the product of its box's two longer edges.
double covered_m2(const PointBlock& block) {
  const auto extent = [](const float(&v)[kBlockSize]) {
    const auto [low, high] = std::minmax_element(std::begin(v), std::end(v));
    return static_cast<double>(*high) - static_cast<double>(*low);
  };
  const double x = extent(block.x), y = extent(block.y), z = extent(block.z);
  return std::max({x * y, y * z, z * x});
}

Array<double> covered_m2_of_blocks(const PointBlocks& points) {
  Array<double> areas(points.blocks.size());
  parallel_chunks(areas.size(), kLoopChunk / kBlockSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) areas[i] = covered_m2(points.blocks[i]);
  });
  // Blocks along a line or on one spot have no area, but they are there; stray points far apart cover no surface.
  constexpr double kLeastOfMedian = 0.01, kStray = 0.02;
  Array<double> ranked = areas;
  const auto at = [&](double share) {
    return value_at_rank(ranked, static_cast<std::size_t>(share * static_cast<double>(ranked.size() - 1)));
  };
  const double least = std::max(kLeastOfMedian * at(0.5), 1e-100);
  const double most = std::max(at(1.0 - kStray), least);
  for (double& area : areas) area = std::clamp(area, least, most);
  return areas;
}

/// Points per area at which all blocks together give `n_wanted`, no block more than it has.
double density_for(const Array<double>& areas, double n_wanted) {
  constexpr double kAll = static_cast<double>(kBlockSize);
  double low = std::log(n_wanted / std::accumulate(areas.begin(), areas.end(), 0.0));
  double high = std::log(kAll / *std::min_element(areas.begin(), areas.end()));
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    const double density = std::exp(middle);
    double n = 0.0;
    for (double area : areas) n += std::min(kAll, density * area);
    (n < n_wanted ? low : high) = middle;
  }
  return std::exp(low);
}

}  // namespace

Array<std::uint32_t> evenly_spread_slots(const PointBlocks& points, std::size_t n_wanted) {
  Array<std::uint32_t> slots;
  if (points.size <= n_wanted) {
    slots.resize(points.size);
    std::iota(slots.begin(), slots.end(), 0u);
    return slots;
  }
  const Array<double> areas = covered_m2_of_blocks(points);
  const double density = density_for(areas, static_cast<double>(n_wanted));
  double due = 0.0;
  for (std::size_t b = 0; b < areas.size(); ++b) {
    const std::size_t first = b * kBlockSize;
    const std::size_t n_here = std::min(kBlockSize, points.size - first);
    due += std::min(static_cast<double>(n_here), density * areas[b]);
    const std::size_t n = std::min(n_here, static_cast<std::size_t>(due) - slots.size());
    for (std::size_t i = 0; i < n; ++i) slots.push_back(static_cast<std::uint32_t>(first + i * n_here / n));
  }
  return slots;
}

}  // namespace cmap
