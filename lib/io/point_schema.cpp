#include "io/point_schema.hpp"

#include <algorithm>
#include <set>

namespace cmap {
namespace {

using Triple = std::array<std::string_view, 3>;
constexpr Triple kColorNames[] = {
    {"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}};

std::optional<std::size_t> find_field(std::span<const Field> fields, std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& field) { return field.name == name; });
  if (found == fields.end()) return std::nullopt;
  return static_cast<std::size_t>(found - fields.begin());
}

void check_names(const ByteSource& source, std::span<const Field> fields) {
  std::set<std::string_view> names;
  for (const Field& field : fields) {
    if (field.name != "_" && !names.insert(field.name).second) {
      source.fail("header: the field '{}' is declared twice", field.name);
    }
  }
}

std::size_t find_coordinate(const ByteSource& source, std::span<const Field> fields, std::string_view name) {
  const auto index = find_field(fields, name);
  if (!index) source.fail("header: points have no field '{}'", name);
  if (!fields[*index].is_scalar()) source.fail("header: the field '{}' is not a single number", name);
  return *index;
}

ColorStorage storage_of(const ByteSource& source, const Field& field) {
  switch (field.type) {
    case ScalarType::kUint8:
      return ColorStorage::kRgb8;
    case ScalarType::kUint16:
      return ColorStorage::kRgb16;
    case ScalarType::kFloat32:
    case ScalarType::kFloat64:
      return ColorStorage::kFloat;
    default:
      source.fail("header: the color '{}' has type {}; uint8, uint16, float32 or float64 expected", field.name,
                  scalar_name(field.type));
  }
}

/// Takes the three fields of these names as color; false if they are not all there.
bool take_separate(const ByteSource& source, std::span<const Field> fields, const Triple& names, PointSchema& schema,
                   FileInfo& info) {
  std::array<std::optional<std::size_t>, 3> found;
  std::transform(names.begin(), names.end(), found.begin(), [&](auto name) { return find_field(fields, name); });
  const auto n_found = std::count_if(found.begin(), found.end(), [](const auto& index) { return index.has_value(); });
  if (n_found == 0) return false;
  if (n_found < 3) {
    info.notes.push_back(fmt::format("no color taken from {} {} {}: only {} of the three present", names[0], names[1],
                                     names[2], n_found));
    return false;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Field& field = fields[*found[k]];
    if (!field.is_scalar()) source.fail("header: the color '{}' is not a single number", field.name);
    const ColorStorage storage = storage_of(source, field);
    if (k > 0 && storage != schema.layout.color)
      source.fail("header: the color '{}' has another type than '{}'", field.name, names[0]);
    schema.layout.color = storage;
    schema.layout.color_names[k] = field.name;
    schema.color_fields[k] = *found[k];
  }
  return true;
}

bool take_packed(std::span<const Field> fields, std::string_view name, PointSchema& schema, FileInfo& info) {
  const auto index = find_field(fields, name);
  if (!index) return false;
  const Field& field = fields[*index];
  if (!field.is_scalar() || scalar_bytes(field.type) != 4) {
    info.notes.push_back(fmt::format("no color taken from '{}': not 4 bytes", name));
    return false;
  }
  schema.layout.color = ColorStorage::kPacked;
  schema.color_fields[0] = *index;
  return true;
}

}  // namespace

PointSchema find_point_schema(const ByteSource& source, std::span<const Field> fields, FileInfo& info) {
  check_names(source, fields);
  PointSchema schema;
  constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    schema.position[axis] = find_coordinate(source, fields, kAxes[axis]);
    if (fields[schema.position[axis]].type != ScalarType::kFloat32) schema.layout.wide = true;
  }
  for (const Triple& names : kColorNames) {
    if (take_separate(source, fields, names, schema, info)) return schema;
  }
  for (const std::string_view name : {"rgb", "rgba"}) {
    if (take_packed(fields, name, schema, info)) return schema;
  }
  return schema;
}

}  // namespace cmap
