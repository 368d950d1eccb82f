#include <algorithm>
#include <cmath>
#include <ranges>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/metrics/wasserstein.hpp"

namespace cmap {
namespace {

/// Where the voxels of each x begin, and the end.
std::vector<std::size_t> rows_of(std::span<const VoxelDistance> voxels) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (i == 0 || voxels[i].index[0] != voxels[i - 1].index[0]) rows.push_back(i);
  }
  rows.push_back(voxels.size());
  return rows;
}

/// What is within a radius of a voxel in x and y, as the voxel moves on in their order: of each row in reach voxels
/// that follow each other, whose ends move on with it.
class Neighborhood {
 public:
  struct Stretch {
    std::size_t begin, end, row_end;
  };

  Neighborhood(std::span<const VoxelDistance> voxels, std::span<const std::size_t> rows, int radius)
      : voxels_(voxels), rows_(rows), radius_(radius) {}

  std::span<const Stretch> around(const VoxelDistance& center) {
    if (stretches_.empty() || center.index[0] != x_) enter_row(center);
    const std::int64_t lowest = center.index[1] - radius_, highest = center.index[1] + radius_;
    for (Stretch& stretch : stretches_) {
      while (stretch.begin < stretch.row_end && y(stretch.begin) < lowest) ++stretch.begin;
      while (stretch.end < stretch.row_end && y(stretch.end) <= highest) ++stretch.end;
    }
    return stretches_;
  }

 private:
  std::int64_t y(std::size_t voxel) const { return voxels_[voxel].index[1]; }

  void enter_row(const VoxelDistance& center) {
    x_ = center.index[0];
    stretches_.clear();
    const auto x = [&](std::size_t row) { return voxels_[rows_[row]].index[0]; };
    const auto all = std::views::iota(std::size_t{0}, rows_.size() - 1);
    const auto first = std::ranges::partition_point(all, [&](std::size_t row) { return x(row) < x_ - radius_; });
    for (std::size_t row = *first; row + 1 < rows_.size() && x(row) <= x_ + radius_; ++row) {
      const auto of_row = std::views::iota(rows_[row], rows_[row + 1]);
      const auto is_before = [&](std::size_t voxel) { return y(voxel) < center.index[1] - radius_; };
      const std::size_t begin = *std::ranges::partition_point(of_row, is_before);
      stretches_.push_back({begin, begin, rows_[row + 1]});
    }
  }

  std::span<const VoxelDistance> voxels_;
  std::span<const std::size_t> rows_;
  int radius_;
  std::int64_t x_ = 0;
  std::vector<Stretch> stretches_;
};

/// Differences of the distances around a voxel to its own, which is among them.
void find_differences(std::span<const VoxelDistance> voxels, const VoxelDistance& center,
                      std::span<const Neighborhood::Stretch> around, int radius, std::vector<double>& differences) {
  std::size_t n = 0;
  for (const Neighborhood::Stretch& stretch : around) n += stretch.end - stretch.begin;
  differences.resize(n);
  std::size_t n_near = 0;
  for (const Neighborhood::Stretch& stretch : around) {
    for (std::size_t i = stretch.begin; i < stretch.end;
         ++i) {  // without a branch: which of them are near cannot be foretold
      differences[n_near] = voxels[i].distance_m - center.distance_m;
      n_near += std::abs(voxels[i].index[2] - center.index[2]) <= radius ? 1 : 0;
    }
  }
  differences.resize(n_near);
}

/// Coefficient of variation of the distances around a voxel; NaN where the voxel is to be skipped.
/// Differences to the voxel's own distance are summed: equal distances give a variance of exactly 0, and the voxel
/// itself adds nothing.
double local_variation(double center_m, std::span<const double> differences) {
  double sum = 0.0, sum_sq = 0.0;
  for (const double difference : differences) {
    sum += difference;
    sum_sq += difference * difference;
  }
  const auto n = static_cast<double>(differences.size() - 1);
  const double mean = center_m + sum / n;
  const double variance = std::max(0.0, sum_sq / n - (sum / n) * (sum / n));
  return n > 0.0 && mean > 0.0 ? std::sqrt(variance) / mean : std::nan("");
}

}  // namespace

std::vector<double> local_variations(std::span<const VoxelDistance> voxels, int radius_voxels) {
  constexpr std::size_t kVoxelChunk = 512;
  const std::vector<std::size_t> rows = rows_of(voxels);
  std::vector<double> variations(voxels.size());
  parallel_chunks(voxels.size(), kVoxelChunk, [&](std::size_t begin, std::size_t end) {
    Neighborhood neighborhood(voxels, rows, radius_voxels);
    std::vector<double> differences;
    for (std::size_t i = begin; i < end; ++i) {
      find_differences(voxels, voxels[i], neighborhood.around(voxels[i]), radius_voxels, differences);
      variations[i] = local_variation(voxels[i].distance_m, differences);
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
