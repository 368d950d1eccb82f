#pragma once

#include <array>
#include <cstdint>

#include "io/byte_source.hpp"

namespace cmap {

/// What a LAS header says about the points.
struct LasHeader {
  int version_minor = 0;
  int point_format = 0;
  std::uint64_t points = 0;
  std::uint64_t data_offset = 0;  ///< bytes from the start of the file
  std::size_t record_bytes = 0;
  std::size_t rgb_offset = 0;  ///< in a record; 0: no color
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
};

/// Reads the header; the source then stands behind it, before data_offset. Throws InputError naming the field; refuses
/// LAZ with the command that converts it.
LasHeader read_las_header(ByteSource& source);

}  // namespace cmap
