#pragma once

#include <cstdint>

namespace cmap {

/// The nearest whole number of 32 bits; the end beyond those, and of NaN the lower one.
inline std::uint32_t whole_32(double value) {
  constexpr double kMost = 0x1p32 - 1.0;
  const double rounded = value + 0.5;
  const double not_below = rounded > 0.0 ? rounded : 0.0;
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(not_below < kMost ? not_below : kMost));
}

/// A sum of whole numbers in 128 bits: two words, of which compilers make less than of their own type.
struct WideSum {
  std::uint64_t low = 0, high = 0;

  void add(std::uint64_t term) {
    low += term;
    high += low < term ? 1 : 0;
  }
  WideSum& operator+=(const WideSum& other) {
    add(other.low);
    high += other.high;
    return *this;
  }
  friend bool operator==(const WideSum&, const WideSum&) = default;

  __extension__ using Integer = unsigned __int128;
  Integer value() const { return Integer{high} << 64 | low; }
};

}  // namespace cmap
