#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "cmap/core/warning.hpp"

namespace cmap {

/// Packed colors in a field of floats, on their way in: whether the floats have the bits 0x..RRGGBB, as PCL means it.
/// Where their values are these integers (4.29490e+09), single precision and few digits have taken the low bytes, and
/// nothing gives them back; where bits were printed with few digits, the low byte is noise.
class PackedFloats {
 public:
  /// A float as a binary file holds it.
  void add(float value);
  /// One that was printed as `token`, which is no whole number.
  void add_printed(std::string_view token, float value);
  /// An integer that was printed whole in a field of floats.
  void add_whole(std::uint32_t packed);
  void add(const PackedFloats& others);

  /// Why the colors are none; empty where they may be some.
  std::string why_no_color() const;
  /// That they are rounded, if they are.
  std::optional<Warning> rounded() const;

 private:
  std::uint64_t n_numbers_ = 0;   ///< whose value is an integer in place of bits
  float number_ = 0.0F;           ///< the first of them
  std::uint64_t n_whole_ = 0;     ///< beyond what floats hold exactly
  std::uint32_t whole_bits_ = 0;  ///< that any of those has
  std::uint64_t n_printed_ = 0, n_rounded_ = 0;
  std::size_t most_digits_ = 0;  ///< of the rounded ones, and among those with as many:
  double largest_error_ = 0.0;   ///< of the packed integer
  std::string example_;          ///< a rounded one as printed
};

}  // namespace cmap
