#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>

#include "whole_sums.hpp"

namespace cmap {

/// Number, sums and sum of squares of a voxel's colors, in whole steps of 2^-24 of 1/255 (as 8-bit colors are, and
/// floats from half of 1/255 on), and whether its points are all at one place: neither the order nor the grouping of
/// the points changes a bit. For up to 2^31 points. Not thread-safe.
class ColorMoments {
 public:
  /// A color in units of 1/255.
  void add(const Eigen::Vector3f& color, const Eigen::Vector3f& place) {
    if (++n_ == 1) {
      place_ = place;
      first_ = color;
      return;
    }
    one_place_ = one_place_ && place == place_;
    add_to_sums(color);
  }

  ColorMoments& operator+=(const ColorMoments& other) {
    if (other.n_ == 0) return *this;
    if (n_ == 0) return *this = other;
    one_place_ = one_place_ && other.one_place_ && other.place_ == place_;
    n_ += other.n_;
    add_to_sums(other.first_);
    for (std::size_t channel = 0; channel < 3; ++channel) sum_[channel] += other.sum_[channel];
    squares_ += other.squares_;
    return *this;
  }

  std::uint64_t n() const { return n_; }
  bool one_place() const { return one_place_; }

  /// Trace of the covariance in unit RGB squared; 0 of one point.
  double covariance_trace() const {
    if (n_ < 2) return 0.0;
    ColorMoments all = *this;
    all.add_to_sums(first_);
    const auto count = static_cast<double>(n_);
    double sq_sum = 0.0;
    for (const std::uint64_t sum : all.sum_) sq_sum += in_255(sum) * in_255(sum);
    const double sum_sq = static_cast<double>(all.squares_.value()) / (kSteps * kSteps);
    return std::max(0.0, (sum_sq - sq_sum / count) / (count - 1.0)) / (255.0 * 255.0);
  }

 private:
  static constexpr double kSteps = 0x1p24;  ///< in 1/255
  void add_to_sums(const Eigen::Vector3f& color) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const std::uint64_t c = whole_32(kSteps * static_cast<double>(color[static_cast<Eigen::Index>(channel)]));
      sum_[channel] += c;
      squares_.add(c * c);
    }
  }
  static double in_255(std::uint64_t sum) { return static_cast<double>(sum) / kSteps; }

  std::uint32_t n_ = 0;
  bool one_place_ = true;
  Eigen::Vector3f place_ = Eigen::Vector3f::Zero(), first_ = Eigen::Vector3f::Zero();  ///< of the first point
  std::array<std::uint64_t, 3> sum_{};  ///< of the others: many voxels hold a single point
  WideSum squares_;
};

}  // namespace cmap
