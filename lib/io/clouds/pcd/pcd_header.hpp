#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clouds/point_schema.hpp"
#include "cmap/io/line_reader.hpp"

namespace cmap {

enum class PcdData { kAscii, kBinary, kCompressed };

struct PcdHeader {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  PcdData data = PcdData::kAscii;
};

/// Reads up to and including the line DATA. Throws InputError naming the line; a VIEWPOINT that is
/// not the identity goes to info.sensor_positions.
PcdHeader read_pcd_header(LineReader& lines, FileInfo& info);

}  // namespace cmap
