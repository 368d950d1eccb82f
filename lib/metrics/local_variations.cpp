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

/// A voxel of a neighborhood.
struct Neighbor {
  std::int64_t z;
  double distance_m;
};

/// Where the columns of each x begin, and the end.
std::vector<std::size_t> rows_of(std::span<const Column> columns) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (i == 0 || columns[i].x != columns[i - 1].x) rows.push_back(i);
  }
  rows.push_back(columns.size());
  return rows;
}

/// The voxels of the columns within a radius of a column, in order.
class Neighborhoods {
 public:
  Neighborhoods(std::span<const VoxelDistance> voxels, int radius)
      : voxels_(voxels), radius_(radius), columns_(columns_of(voxels)), rows_(rows_of(columns_)) {}

  std::span<const Column> columns() const { return columns_; }

  void find(const Column& center, std::vector<Neighbor>& around) const {
    around.clear();
    const auto before = [&](std::size_t row) { return row < columns_.size() && columns_[row].x < center.x - radius_; };
    auto row = std::ranges::partition_point(rows_, before);
    for (; *row < columns_.size() && columns_[*row].x <= center.x + radius_; ++row) {
      const std::span<const Column> of_row = std::span(columns_).subspan(*row, *std::next(row) - *row);
      auto column = std::ranges::partition_point(of_row, [&](const Column& c) { return c.y < center.y - radius_; });
      for (; column != of_row.end() && column->y <= center.y + radius_; ++column) add(*column, around);
    }
  }

 private:
  void add(const Column& column, std::vector<Neighbor>& around) const {
    for (std::size_t i = column.begin; i < column.end; ++i) {
      around.push_back({voxels_[i].index[2], voxels_[i].distance_m});
    }
  }

  std::span<const VoxelDistance> voxels_;
  int radius_;
  std::vector<Column> columns_;
  std::vector<std::size_t> rows_;
};

/// Coefficient of variation of the distances around a voxel; NaN where the voxel is to be skipped.
/// Differences to the voxel's own distance are summed: equal distances give a variance of exactly 0, and the voxel
/// itself, which is among those around it, adds nothing.
double local_variation(const VoxelDistance& center, std::span<const Neighbor> around, int radius,
                       std::vector<double>& differences) {
  differences.resize(around.size());
  std::size_t n_near = 0;
  for (const Neighbor& other : around) {  // without a branch: which of them are near cannot be foretold
    differences[n_near] = other.distance_m - center.distance_m;
    n_near += std::abs(other.z - center.index[2]) <= radius ? 1 : 0;
  }
  double sum = 0.0, sum_sq = 0.0;
  for (const double difference : std::span(differences).first(n_near)) {
    sum += difference;
    sum_sq += difference * difference;
  }
  const auto n = static_cast<double>(n_near - 1);
  const double mean = center.distance_m + sum / n;
  const double variance = std::max(0.0, sum_sq / n - (sum / n) * (sum / n));
  return n > 0.0 && mean > 0.0 ? std::sqrt(variance) / mean : std::nan("");
}

}  // namespace

std::vector<double> local_variations(std::span<const VoxelDistance> voxels, int radius_voxels) {
  constexpr std::size_t kColumnChunk = 64;
  const Neighborhoods neighborhoods(voxels, radius_voxels);
  const std::span<const Column> columns = neighborhoods.columns();
  std::vector<double> variations(voxels.size());
  parallel_chunks(columns.size(), kColumnChunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbor> around;
    std::vector<double> differences;
    for (const Column& column : columns.subspan(begin, end - begin)) {
      neighborhoods.find(column, around);
      for (std::size_t i = column.begin; i < column.end; ++i) {
        variations[i] = local_variation(voxels[i], around, radius_voxels, differences);
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
