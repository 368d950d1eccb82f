#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cmap/io/point_cloud_file.hpp"
#include "io/byte_source.hpp"
#include "io/cloud_builder.hpp"
#include "io/scalar_type.hpp"

namespace cmap {

/// A named member of each point, as a header declares it: a scalar, `count` of them (PCD), or a list (PLY).
struct Field {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
  std::size_t count = 1;
  std::optional<ScalarType> list_count_type;  ///< set: a list whose length is stored before it, as this type

  bool is_scalar() const { return count == 1 && !list_count_type; }
};

/// Which fields are position and color.
struct PointSchema {
  std::array<std::size_t, 3> position{};
  std::array<std::size_t, 3> color_fields{};  ///< of CloudLayout::color; kPacked uses the first
  CloudLayout layout;
};

/// Finds x y z and, by the names that are in use, the colors. Throws InputError if a coordinate is missing or a color
/// has a type that cannot be one; notes color fields that do not make a color.
PointSchema find_point_schema(const ByteSource& source, std::span<const Field> fields, FileInfo& info);

}  // namespace cmap
