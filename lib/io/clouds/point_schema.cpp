#include "clouds/point_schema.hpp"

#include <algorithm>
#include <set>

#include "clouds/point_names.hpp"

namespace cmap {
namespace {

void check_names(const ByteSource& source, std::span<const Field> fields) {
  std::set<std::string_view> names;
  for (const Field& field : fields) {
    if (field.name != "_" && !names.insert(field.name).second) {
      source.fail("header: the field '{}' is declared twice", field.name);
    }
  }
}

std::vector<std::string> names_of(std::span<const Field> fields) {
  std::vector<std::string> names;
  for (const Field& field : fields) names.push_back(field.name);
  return names;
}

void fail_without_position(const ByteSource& source, const std::vector<std::string>& names) {
  if (names_degrees(names)) {
    source.fail(
        "header: the points are given as longitude and latitude; project them to meters first (pdal translate "
        "with filters.reprojection)");
  }
  for (const std::string_view axis : {"x", "y", "z"}) {
    const auto is_axis = [&](const std::string& name) { return plain_name(name) == axis; };
    if (std::none_of(names.begin(), names.end(), is_axis)) {
      source.fail("header: points have no field '{}'; they have {}", axis, listed(names));
    }
  }
}

void take_position(const ByteSource& source, std::span<const Field> fields, const PointNames& found,
                   PointSchema& schema) {
  schema.position = *found.position;
  for (const std::size_t index : schema.position) {
    const Field& field = fields[index];
    if (!field.is_scalar()) source.fail("header: the field '{}' is not a single number", field.name);
    if (field.type != ScalarType::kFloat32) schema.layout.wide = true;
  }
}

/// The type that stands for all three: theirs, or none of the small ones where they differ.
ScalarType common_type(const std::array<ScalarType, 3>& types) {
  if (types[0] == types[1] && types[1] == types[2]) return types[0];
  const bool any_floating = std::any_of(types.begin(), types.end(), is_floating);
  return any_floating ? ScalarType::kFloat32 : ScalarType::kInt32;
}

void take_separate(const ByteSource& source, std::span<const Field> fields, const ColumnTriple& found,
                   PointSchema& schema) {
  std::array<ScalarType, 3> types{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Field& field = fields[found[k]];
    if (!field.is_scalar()) source.fail("header: the color '{}' is not a single number", field.name);
    types[k] = field.type;
    schema.layout.color.names[k] = field.name;
  }
  schema.layout.color.storage = ColorStorage::kSeparate;
  schema.layout.color.type = common_type(types);
  schema.color_fields = found;
}

void take_packed(const Field& field, std::size_t index, PointSchema& schema, FileInfo& info) {
  if (!field.is_scalar() || scalar_bytes(field.type) != 4) {
    info.notes.push_back(fmt::format("no color taken from '{}': not 4 bytes", field.name));
    return;
  }
  schema.layout.color.storage = ColorStorage::kPacked;
  schema.layout.color.type = ScalarType::kUint8;
  schema.color_fields[0] = index;
}

void note_unused_fields(std::span<const std::string> names, const PointSchema& schema, FileInfo& info) {
  std::set<std::size_t> used(schema.position.begin(), schema.position.end());
  if (schema.layout.color.storage == ColorStorage::kSeparate) {
    used.insert(schema.color_fields.begin(), schema.color_fields.end());
  } else if (schema.layout.color.storage == ColorStorage::kPacked) {
    used.insert(schema.color_fields[0]);
  }
  std::vector<std::string> unused;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string plain = plain_name(names[i]);
    if (used.count(i) == 0 && plain != "alpha" && plain != "a") unused.push_back(names[i]);
  }
  note_unused(unused, "fields", info);
}

}  // namespace

std::string listed(std::span<const std::string> names) {
  constexpr std::size_t kMostNames = 10;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMostNames; ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > kMostNames ? fmt::format("{} and {} more", text, names.size() - kMostNames) : text;
}

void note_unused(std::span<const std::string> names, const char* what, FileInfo& info) {
  std::vector<std::string> said;
  std::copy_if(names.begin(), names.end(), std::back_inserter(said),
               [](const std::string& name) { return !name.empty() && name != "_"; });
  if (!said.empty()) info.notes.push_back(fmt::format("{} not used: {}", what, listed(said)));
}

PointSchema find_point_schema(const ByteSource& source, std::span<const Field> fields, FileInfo& info) {
  check_names(source, fields);
  const std::vector<std::string> names = names_of(fields);
  const PointNames found = find_point_names(names);
  if (!found.position) fail_without_position(source, names);
  if (!found.position) source.fail("header: no fields x y z; there are {}", listed(names));
  PointSchema schema;
  take_position(source, fields, found, schema);
  if (found.color) {
    take_separate(source, fields, *found.color, schema);
  } else if (found.packed_color) {
    take_packed(fields[*found.packed_color], *found.packed_color, schema, info);
  } else if (found.n_color_channels > 0) {
    info.notes.push_back(
        fmt::format("no color taken: only {} of the three fields red, green, blue present", found.n_color_channels));
  }
  note_units(names, schema.position, info);
  note_unused_fields(names, schema, info);
  return schema;
}

void note_units(std::span<const std::string> names, const ColumnTriple& position, FileInfo& info) {
  const std::string_view unit = unit_in_name(names[position[0]]);
  if (unit.empty()) return;
  info.warnings.push_back({"unit_in_name", fmt::format("the name '{}' says {}, but coordinates are taken as meters; "
                                                       "--transform scales them",
                                                       names[position[0]], unit)});
}

}  // namespace cmap
