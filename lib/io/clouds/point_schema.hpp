#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bytes/scalar_type.hpp"
#include "clouds/cloud_builder.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/point_cloud_file.hpp"

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

/// Finds x y z and the colors by their names (PointNames). Throws InputError if a coordinate is missing; notes color
/// fields that do not make a color, and the fields that nothing is taken from.
PointSchema find_point_schema(const ByteSource& source, std::span<const Field> fields, FileInfo& info);

/// "a, b, c and 4 more".
std::string listed(std::span<const std::string> names);

/// Notes "<what> not used: a, b, c", if there are any.
void note_unused(std::span<const std::string> names, const char* what, FileInfo& info);

/// Warns where the name of a coordinate says another unit than meters.
void note_units(std::span<const std::string> names, const std::array<std::size_t, 3>& position, FileInfo& info);

}  // namespace cmap
