#pragma once

#include <array>
#include <cstdint>

#include "cmap/io/byte_source.hpp"

namespace cmap {

/// What a LAS header says about the points, and where it says that other things are.
struct LasHeader {
  int version_minor = 0;
  int point_format = 0;
  std::uint64_t points = 0;
  std::uint64_t legacy_points = 0;  ///< the 32-bit count; 0 where a file has only the 64-bit one
  std::uint64_t data_offset = 0;    ///< bytes from the start of the file
  std::size_t record_bytes = 0;
  std::size_t rgb_offset = 0;  ///< in a record; 0: no color
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
  std::uint64_t header_bytes = 0;
  std::uint32_t vlrs = 0;             ///< variable-length records between header and points
  std::uint32_t extended_vlrs = 0;    ///< behind the points; where waveforms are, at least theirs
  std::uint64_t extended_offset = 0;  ///< where those start
  bool wkt_counts = false;            ///< the coordinate system is the WKT's, not the GeoKeys'

  bool extended_format() const { return point_format >= 6; }
  std::uint64_t data_end() const { return data_offset + points * record_bytes; }
};

/// Reads the header; the source then still stands at its first byte. Throws InputError naming the field; refuses files
/// with the compression bits of LAZ with the command that converts them.
LasHeader read_las_header(ByteSource& source);

[[noreturn]] void refuse_laz(const ByteSource& source);

}  // namespace cmap
