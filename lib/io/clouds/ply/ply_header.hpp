#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clouds/point_schema.hpp"
#include "cmap/io/line_reader.hpp"

namespace cmap {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Field> properties;

  bool has_lists() const;
  /// Of a row without lists.
  std::uint64_t row_bytes() const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::size_t vertex = 0;  ///< index of the element that holds the points
};

/// Reads up to and including the line "end_header". Throws InputError naming the line; refuses Gaussian splats.
PlyHeader read_ply_header(LineReader& lines);

}  // namespace cmap
