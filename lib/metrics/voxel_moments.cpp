#include "voxel_moments.hpp"

#include <algorithm>
#include <cmath>

namespace cmap {
namespace {

__extension__ using Signed = __int128;

/// Within an ulp: the two words of the magnitude, one after the other. Faster than the compiler's own, which rounds
/// once.
double in_double(Signed value) {
  const WideSum::Integer magnitude = static_cast<WideSum::Integer>(value < 0 ? -value : value);
  const double found = static_cast<double>(static_cast<std::uint64_t>(magnitude >> 64)) * 0x1p64 +
                       static_cast<double>(static_cast<std::uint64_t>(magnitude));
  return value < 0 ? -found : found;
}

using Integer = WideSum::Integer;

Integer wrapped(std::int64_t value) { return static_cast<Integer>(static_cast<Signed>(value)); }

WideSum wide(Integer value) { return {static_cast<std::uint64_t>(value), static_cast<std::uint64_t>(value >> 64)}; }

}  // namespace

VoxelSteps::VoxelSteps(double voxel_m)
    : step_m_(std::ldexp(1.0, std::max(-30, std::ilogb(voxel_m) + 1 - 32))),
      steps_per_voxel_(std::llround(voxel_m / step_m_)) {}

VoxelMoments& VoxelMoments::operator+=(const VoxelMoments& other) {
  n_ += other.n_;
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += other.sum_[i];
  for (std::size_t i = 0; i < products_.size(); ++i) products_[i] += other.products_[i];
  return *this;
}

VoxelMoments& VoxelMoments::operator-=(const VoxelMoments& other) {
  n_ -= other.n_;
  for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] -= other.sum_[i];
  for (std::size_t i = 0; i < products_.size(); ++i) {
    products_[i] = wide(products_[i].value() - other.products_[i].value());
  }
  return *this;
}

void VoxelMoments::move(const Corner& by) {
  if (n_ == 0) return;
  std::size_t product = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = i; k < 3; ++k, ++product) {
      products_[product] +=
          wide(wrapped(by[k]) * sum_[i] + wrapped(by[i]) * sum_[k] + n_ * wrapped(by[i]) * wrapped(by[k]));
    }
  }
  for (std::size_t i = 0; i < 3; ++i) sum_[i] += n_ * static_cast<std::uint64_t>(by[i]);
}

Gaussian VoxelMoments::gaussian(double step_m, const Corner& from) const {
  const auto n = static_cast<double>(n_);
  Gaussian gaussian;
  gaussian.n = n_;
  std::array<Integer, 3> sums;  // without having wrapped at 2^64
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint64_t near_sum = sum_[i] - n_ * static_cast<std::uint64_t>(from[i]);
    gaussian.mean[static_cast<Eigen::Index>(i)] = static_cast<double>(near_sum) / n * step_m;
    sums[i] = near_sum + n_ * wrapped(from[i]);
  }
  std::size_t product = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = i; k < 3; ++k) {
      // Exact, as it is at most 2^126 for points within 2^32 steps, and then rounded.
      const auto scaled = static_cast<Signed>(n_ * products_[product++].value() - sums[i] * sums[k]);
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(k);
      gaussian.scatter(row, column) = gaussian.scatter(column, row) = in_double(scaled) / n * (step_m * step_m);
    }
  }
  return gaussian;
}

}  // namespace cmap
