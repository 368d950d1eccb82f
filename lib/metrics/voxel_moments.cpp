#include "voxel_moments.hpp"

#include <algorithm>
#include <cmath>

namespace cmap {
namespace {

Eigen::Vector3d base_of(const VoxelFrame& frame) {
  const auto [x, y, z] = frame.index(VoxelKey{});
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

__extension__ using Signed = __int128;

/// Within an ulp: the two words of the magnitude, one after the other. Faster than the compiler's own, which rounds
/// once.
double in_double(Signed value) {
  const WideSum::Integer magnitude = static_cast<WideSum::Integer>(value < 0 ? -value : value);
  const double found = static_cast<double>(static_cast<std::uint64_t>(magnitude >> 64)) * 0x1p64 +
                       static_cast<double>(static_cast<std::uint64_t>(magnitude));
  return value < 0 ? -found : found;
}

/// n sum xy - sum x sum y: exact, as both are at most 2^126 for n points of 2^32 steps, and then rounded.
double scaled_scatter(std::uint64_t n, const WideSum& products, std::uint64_t sum_x, std::uint64_t sum_y) {
  return in_double(static_cast<Signed>(n * products.value() - WideSum::Integer{sum_x} * sum_y));
}

WideSum wide(WideSum::Integer value) {
  return {static_cast<std::uint64_t>(value), static_cast<std::uint64_t>(value >> 64)};
}

}  // namespace

VoxelSteps::VoxelSteps(const VoxelFrame& frame, double voxel_m)
    : base_(base_of(frame)),
      voxel_m_(voxel_m),
      step_m_(std::ldexp(1.0, std::max(-30, std::ilogb(voxel_m) + 1 - 32))),
      steps_per_m_(1.0 / step_m_) {}

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

void VoxelMoments::add_moved(const VoxelMoments& other, const std::array<std::int64_t, 3>& by) {
  if ((by[0] | by[1] | by[2]) == 0) {
    *this += other;
    return;
  }
  // In unsigned words, which wrap: what comes out is not negative.
  using Integer = WideSum::Integer;
  const auto wrapped = [](std::int64_t v) { return static_cast<Integer>(static_cast<Signed>(v)); };
  const Integer n = other.n_;
  n_ += other.n_;
  std::size_t product = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum_[i] += other.sum_[i] + other.n_ * static_cast<std::uint64_t>(by[i]);
    for (std::size_t k = i; k < 3; ++k, ++product) {
      const Integer moved = other.products_[product].value() + wrapped(by[k]) * other.sum_[i] +
                            wrapped(by[i]) * other.sum_[k] + n * wrapped(by[i]) * wrapped(by[k]);
      products_[product] += wide(moved);
    }
  }
}

Gaussian VoxelMoments::gaussian(double step_m) const {
  const auto n = static_cast<double>(n_);
  Gaussian gaussian;
  gaussian.n = n_;
  std::size_t product = 0;
  for (int row = 0; row < 3; ++row) {
    const std::uint64_t sum = sum_[static_cast<std::size_t>(row)];
    gaussian.mean[row] = static_cast<double>(sum) / n * step_m;
    for (int column = row; column < 3; ++column) {
      const std::uint64_t other_sum = sum_[static_cast<std::size_t>(column)];
      const double scatter = scaled_scatter(n_, products_[product++], sum, other_sum) / n * (step_m * step_m);
      gaussian.scatter(row, column) = gaussian.scatter(column, row) = scatter;
    }
  }
  return gaussian;
}

}  // namespace cmap
