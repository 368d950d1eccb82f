#include <algorithm>
#include <cmath>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/metrics/wasserstein.hpp"

namespace cmap {
namespace {

/// The voxels of one x and y, which follow each other.
struct Column {
  std::int64_t x, y;
  std::size_t begin, end;
};

std::vector<Column> columns_of(std::span<const VoxelDistance> voxels) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const auto& [x, y, z] = voxels[i].index;
    if (columns.empty() || columns.back().x != x || columns.back().y != y) columns.push_back({x, y, i, i});
    columns.back().end = i + 1;
  }
  return columns;
}

/// The columns within a radius of one of them, in order.
std::vector<Column> columns_around(std::span<const Column> columns, const Column& center, int radius) {
  std::vector<Column> around;
  for (std::int64_t x = center.x - radius; x <= center.x + radius; ++x) {
    const auto before = [&](const Column& c) { return c.x < x || (c.x == x && c.y < center.y - radius); };
    auto column = std::ranges::partition_point(columns, before);
    for (; column != columns.end() && column->x == x && column->y <= center.y + radius; ++column) {
      around.push_back(*column);
    }
  }
  return around;
}

/// Coefficient of variation of the distances around a voxel; NaN where the voxel is to be skipped.
/// Differences to the voxel's own distance are summed: equal distances give a variance of exactly 0.
double local_variation(std::span<const VoxelDistance> voxels, std::size_t center, std::span<const Column> around,
                       int radius) {
  const std::int64_t z = voxels[center].index[2];
  double n = 0.0, sum = 0.0, sum_sq = 0.0;
  for (const Column& column : around) {
    for (std::size_t other = column.begin; other < column.end; ++other) {
      if (std::abs(voxels[other].index[2] - z) > radius || other == center) continue;
      const double difference = voxels[other].distance_m - voxels[center].distance_m;
      n += 1.0;
      sum += difference;
      sum_sq += difference * difference;
    }
  }
  const double mean = voxels[center].distance_m + sum / n;
  const double variance = std::max(0.0, sum_sq / n - (sum / n) * (sum / n));
  return n > 0.0 && mean > 0.0 ? std::sqrt(variance) / mean : std::nan("");
}

}  // namespace

std::vector<double> local_variations(std::span<const VoxelDistance> voxels, int radius_voxels) {
  constexpr std::size_t kColumnChunk = 64;
  const std::vector<Column> columns = columns_of(voxels);
  std::vector<double> variations(voxels.size());
  parallel_chunks(columns.size(), kColumnChunk, [&](std::size_t begin, std::size_t end) {
    for (const Column& column : std::span(columns).subspan(begin, end - begin)) {
      const std::vector<Column> around = columns_around(columns, column, radius_voxels);
      for (std::size_t i = column.begin; i < column.end; ++i) {
        variations[i] = local_variation(voxels, i, around, radius_voxels);
      }
    }
  });
  return variations;
}

double mean_variation(std::span<const double> variations) {
  ExactSum sum;
  std::uint64_t n = 0;
  for (const double variation : variations) {
    if (std::isnan(variation)) continue;
    sum.add(variation);
    ++n;
  }
  return sum.value() / static_cast<double>(n);
}

}  // namespace cmap
