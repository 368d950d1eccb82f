#include <algorithm>
#include <cmath>
#include <limits>

#include "cmap/core/exact_sum.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/metrics/wasserstein.hpp"
#include "simd/kernels.hpp"

namespace cmap {
namespace {

/// Voxels as the kernels read them.
class VoxelRows {
 public:
  struct Row {
    std::int64_t x;
    std::size_t begin, end;
  };

  explicit VoxelRows(std::span<const VoxelDistance> voxels) {
    for (const VoxelDistance& voxel : voxels) {
      const auto [x, y, z] = voxel.index;
      if (rows_.empty() || rows_.back().x != x) {
        end_row();
        rows_.push_back({x, y_.size(), y_.size()});
      }
      place_.push_back(y_.size());
      add(static_cast<double>(y), static_cast<double>(z), voxel.distance_m);
      rows_.back().end = y_.size();
    }
    end_row();
  }

  std::span<const Row> rows() const { return rows_; }
  double y(std::size_t place) const { return y_[place]; }
  /// The first place in a row from this y on; its end where there is none.
  std::size_t first_from(const Row& row, double y) const {
    const auto ys = std::span(y_).subspan(row.begin, row.end - row.begin);
    return row.begin + static_cast<std::size_t>(std::ranges::lower_bound(ys, y) - ys.begin());
  }
  std::size_t place(std::size_t voxel) const { return place_[voxel]; }

  NearSums near_sums(std::span<const Stretch> stretches, std::size_t center, double radius) const {
    const RowsOfVoxels voxels{y_.data(), z_.data(), distance_m_.data()};
    return metric_kernels().near_sums(voxels, stretches.data(), stretches.size(), center, radius);
  }

 private:
  void add(double y, double z, double distance_m) {
    y_.push_back(y);
    z_.push_back(z);
    distance_m_.push_back(distance_m);
  }
  void end_row() {
    for (std::size_t i = 0; i < RowsOfVoxels::kAtOnce; ++i) add(std::numeric_limits<double>::infinity(), 0.0, 0.0);
  }

  std::vector<Row> rows_;
  std::vector<std::size_t> place_;  ///< by voxel
  std::vector<double> y_, z_, distance_m_;
};

/// What is within a radius of a voxel in x and y, as the voxel moves on in their order: of each row in reach voxels
/// that follow each other, whose ends move on with it.
class Neighborhood {
 public:
  Neighborhood(const VoxelRows& voxels, int radius) : voxels_(voxels), radius_(radius) {}

  std::span<const Stretch> around(const VoxelIndex& center) {
    const auto y = static_cast<double>(center[1]);
    if (stretches_.empty() || center[0] != x_) enter_row(center[0], y);
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      auto& [begin, end] = stretches_[i];
      const std::size_t row_end = rows_[i].end;
      while (begin < row_end && voxels_.y(begin) < y - radius_) ++begin;
      while (end < row_end && voxels_.y(end) <= y + radius_) ++end;
    }
    return stretches_;
  }

 private:
  using Row = VoxelRows::Row;

  void enter_row(std::int64_t x, double y) {
    x_ = x;
    const auto first = std::ranges::lower_bound(voxels_.rows(), x - radius_, {}, &Row::x);
    const auto end = std::ranges::upper_bound(voxels_.rows(), x + radius_, {}, &Row::x);
    rows_ = {first, end};
    stretches_.clear();
    for (const Row& row : rows_) {
      const std::size_t begin = voxels_.first_from(row, y - radius_);
      stretches_.push_back({begin, begin});
    }
  }

  const VoxelRows& voxels_;
  int radius_;
  std::int64_t x_ = 0;
  std::span<const Row> rows_;  ///< in reach in x
  std::vector<Stretch> stretches_;
};

/// Coefficient of variation of the distances around a voxel; NaN where the voxel is to be skipped.
/// Differences to the voxel's own distance are summed: equal distances give a variance of exactly 0, and the voxel
/// itself adds nothing.
double local_variation(double center_m, const NearSums& sums) {
  const double n = sums.n - 1.0;
  const double mean = center_m + sums.sum / n;
  const double variance = std::max(0.0, sums.sum_sq / n - (sums.sum / n) * (sums.sum / n));
  return n > 0.0 && mean > 0.0 ? std::sqrt(variance) / mean : std::nan("");
}

}  // namespace

std::vector<double> local_variations(std::span<const VoxelDistance> voxels, int radius_voxels) {
  constexpr std::size_t kVoxelChunk = 512;
  const VoxelRows rows(voxels);
  std::vector<double> variations(voxels.size());
  parallel_chunks(voxels.size(), kVoxelChunk, [&](std::size_t begin, std::size_t end) {
    Neighborhood neighborhood(rows, radius_voxels);
    for (std::size_t i = begin; i < end; ++i) {
      const std::span<const Stretch> near = neighborhood.around(voxels[i].index);
      variations[i] = local_variation(voxels[i].distance_m, rows.near_sums(near, rows.place(i), radius_voxels));
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
