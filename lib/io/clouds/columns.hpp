#pragma once

#include <array>
#include <cstddef>

#include "bytes/scalar_type.hpp"

namespace cmap {

/// A column of numbers in memory: value i lies at data + i * stride, as a `type`, which need not be aligned.
struct Column {
  const std::byte* data = nullptr;
  std::size_t stride = 0;
  ScalarType type = ScalarType::kFloat32;
};

/// How a file stores color.
enum class ColorStorage {
  kNone,
  kSeparate,  ///< three columns, of any type
  kPacked,    ///< one 32-bit column 0x..RRGGBB, integer or the bits of a float (PCL)
};

/// Points as columns of numbers: records of a file (equal strides) or columns proper (compressed PCD).
struct PointColumns {
  std::array<Column, 3> position;
  bool swap_bytes = false;  ///< the file's byte order is not the machine's
  bool scaled = false;      ///< LAS: coordinate = value * scale + offset
  std::array<double, 3> scale{1.0, 1.0, 1.0};
  std::array<double, 3> offset{0.0, 0.0, 0.0};
  ColorStorage color = ColorStorage::kNone;
  std::array<Column, 3> rgb;  ///< kPacked uses the first
};

/// Writes n positions (3 values each), or n colors, starting with row `first`. Out is float or double for positions,
/// std::uint8_t, std::uint16_t or float for colors.
template <class Real>
void decode_positions(const PointColumns& columns, std::size_t first, std::size_t n, Real* xyz);
template <class Channel>
void decode_colors(const PointColumns& columns, std::size_t first, std::size_t n, Channel* rgb);

/// The floats of kPacked colors as they are.
void decode_packed(const PointColumns& columns, std::size_t first, std::size_t n, float* values);

}  // namespace cmap
