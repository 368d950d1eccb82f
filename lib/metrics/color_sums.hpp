#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "cmap/metrics/map_pair.hpp"
#include "cmap/metrics/wasserstein.hpp"
#include "phase_fold.hpp"

namespace cmap {

/// Number, sums and sums of products of colors in whole steps: neither the order nor the grouping of points changes a
/// bit. Words of 32 bits hold 8-bit colors of 2^16 points.
template <class Word>
class ColorSums {
 public:
  using Words = std::array<Word, 10>;  ///< n; r, g, b; rr, rg, rb, gg, gb, bb

  ColorSums() = default;
  template <class Other>
  explicit ColorSums(const ColorSums<Other>& other) {
    std::ranges::copy(other.words(), sums_.begin());
  }

  void add(const std::array<Word, 3>& color) {
    const auto [r, g, b] = color;
    const Words terms{1, r, g, b, r * r, r * g, r * b, g * g, g * b, b * b};
    for (std::size_t i = 0; i < terms.size(); ++i) sums_[i] += terms[i];
  }
  ColorSums& operator+=(const ColorSums& other) {
    const Words terms = other.sums_;  // of which compilers know that they are not those that change: several at a time
    for (std::size_t i = 0; i < terms.size(); ++i) sums_[i] += terms[i];
    return *this;
  }

  /// Takes points off that are among them.
  ColorSums& operator-=(const ColorSums& other) {
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] -= other.sums_[i];
    return *this;
  }

  std::uint64_t n() const { return sums_[0]; }
  const Words& words() const { return sums_; }

  /// Of at least one point, in the unit of which a step is `step`. About whole numbers near the means, so that colors
  /// that are all alike have a scatter of 0.
  Gaussian gaussian(double step) const requires(sizeof(Word) == 8) {
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

  Words sums_{};
};

using WideColorSums = ColorSums<std::uint64_t>;
using NarrowColorSums = ColorSums<std::uint32_t>;

inline constexpr std::uint64_t kMostNarrow = std::uint64_t{1} << 16;  ///< points whose sums are right in narrow words

inline bool has_8_bit_colors(const BothSides<const IndexedMap*>& maps) {
  const auto is_8_bit = [](const IndexedMap* map) { return map == nullptr || map->has_8_bit_colors; };
  return is_8_bit(maps.estimate) && is_8_bit(maps.reference);
}

/// The colors of points for a PhaseFold, in steps of their own where all are 8-bit. Otherwise, of maps of n points, a
/// color has so many bits that n squares fit 63: 16 for 2^31 points, 24 for 2^15.
template <class Word>
struct ColorSource {
  using Moments = ColorSums<Word>;

  ColorSource(const BothSides<const IndexedMap*>& maps, bool with_halves) : halves(with_halves) {
    std::size_t n = 1;
    for (const IndexedMap* map : {maps.estimate, maps.reference}) n = map == nullptr ? n : std::max(n, map->size());
    const int bits = std::min(24, (63 - static_cast<int>(std::bit_width(n))) / 2);
    steps_per_level = has_8_bit_colors(maps) ? 1.0 : 257.0 * std::ldexp(1.0, bits - 16);
    step = 1.0 / (255.0 * steps_per_level);
  }

  bool counts(const IndexedMap& map, std::size_t slot) const { return map.has_color_at(slot); }
  struct Terms {
    std::array<Word, kBlockSize> r, g, b;
    std::array<Word, 3> at(std::size_t lane) const { return {r[lane], g[lane], b[lane]}; }
  };
  Terms terms(const IndexedMap& map, std::size_t block, const PartGrid&, const GridPlaces&) const {
    const ColorBlock& color = map.colors[block];
    Terms terms;
    for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
      terms.r[lane] = whole(color.r[lane]);
      terms.g[lane] = whole(color.g[lane]);
      terms.b[lane] = whole(color.b[lane]);
    }
    return terms;
  }
  void to_frame(Moments&, const VoxelKey&) const {}

  bool halves;
  double steps_per_level;  ///< in 1/255
  double step;             ///< unit RGB

 private:
  /// 0 of a point without a color.
  Word whole(float color) const {
    const float level = color > 0.0f ? color : 0.0f;
    if constexpr (sizeof(Word) == 4) return static_cast<Word>(static_cast<std::int32_t>(level));
    return static_cast<Word>(static_cast<std::int64_t>(steps_per_level * static_cast<double>(level) + 0.5));
  }
};

using WideColorSource = ColorSource<std::uint64_t>;

}  // namespace cmap
