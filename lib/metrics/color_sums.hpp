#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "cmap/metrics/map_pair.hpp"
#include "cmap/metrics/wasserstein.hpp"
#include "phase_fold.hpp"

namespace cmap {

/// Number, sums and sums of products of colors in whole steps, in 63 bits: neither the order nor the grouping of points
/// changes a bit. 8-bit and 16-bit colors are whole; others are rounded to steps of 2^-16 of a 16-bit level at least.
class ColorSums {
 public:
  void add(const std::array<std::uint64_t, 3>& color) {
    const auto [r, g, b] = color;
    const std::array<std::uint64_t, 10> terms{1, r, g, b, r * r, r * g, r * b, g * g, g * b, b * b};
    for (std::size_t i = 0; i < terms.size(); ++i) sums_[i] += terms[i];
  }
  ColorSums& operator+=(const ColorSums& other) {
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
    return *this;
  }

  std::uint64_t n() const { return sums_[0]; }

  /// Of at least one point, in the unit of which a step is `step`. About whole numbers near the means, so that colors
  /// that are all alike have a scatter of 0.
  Gaussian gaussian(double step) const {
    const double per_point = 1.0 / in_double(n());
    Gaussian gaussian;
    gaussian.n = n();
    std::array<std::uint64_t, 3> center{};
    std::array<double, 3> rest{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double mean = in_double(sum(i)) * per_point;
      center[i] = static_cast<std::uint64_t>(static_cast<std::int64_t>(mean));
      rest[i] = in_double(sum(i) - n() * center[i]);
      gaussian.mean[static_cast<Eigen::Index>(i)] = mean * step;
    }
    std::size_t product = 4;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = i; k < 3; ++k) {
        // Words wrap; what comes out is at most as large as the products.
        const std::uint64_t about =
            sums_[product++] - center[i] * sum(k) - center[k] * sum(i) + n() * center[i] * center[k];
        const double scatter = in_double(about) - rest[i] * rest[k] * per_point;
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(k);
        gaussian.scatter(row, column) = gaussian.scatter(column, row) = scatter * (step * step);
      }
    }
    return gaussian;
  }

 private:
  static double in_double(std::uint64_t word) { return static_cast<double>(static_cast<std::int64_t>(word)); }
  std::uint64_t sum(std::size_t channel) const { return sums_[1 + channel]; }

  std::array<std::uint64_t, 10> sums_{};  ///< n; r, g, b; rr, rg, rb, gg, gb, bb
};

/// The colors of points for a PhaseFold. Of maps of n points a color has so many bits that n squares fit 63: 16 for
/// 2^31 points, 24 for 2^15.
struct ColorSource {
  using Moments = ColorSums;

  ColorSource(const BothSides<const IndexedMap*>& maps, bool with_halves) : halves(with_halves) {
    std::size_t n = 1;
    for (const IndexedMap* map : {maps.estimate, maps.reference}) n = map == nullptr ? n : std::max(n, map->size());
    const int bits = std::min(24, (63 - static_cast<int>(std::bit_width(n))) / 2);
    steps_per_level = 257.0 * std::ldexp(1.0, bits - 16);
    step = 1.0 / (255.0 * steps_per_level);
  }

  bool counts(const IndexedMap& map, std::size_t slot) const { return map.has_color_at(slot); }
  void add(Moments& moments, const IndexedMap& map, std::size_t slot, const Eigen::Vector3d&, const VoxelKey&) const {
    const Eigen::Vector3f color = color_at(map.colors, slot);
    const auto whole = [&](float level) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(steps_per_level * static_cast<double>(level) + 0.5));
    };
    moments.add({whole(color.x()), whole(color.y()), whole(color.z())});
  }
  static constexpr bool kHasCorners = false;
  void merge(Moments& into, const Moments& part) const { into += part; }

  bool halves;
  double steps_per_level;  ///< in 1/255
  double step;             ///< unit RGB
};

}  // namespace cmap
