#include <algorithm>
#include <cctype>

#include "clouds/numpy/npy_points.hpp"
#include "clouds/point_schema.hpp"

namespace cmap {
namespace {

std::string lower(std::string_view name) {
  std::string text(name);
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The names of the members of a column that is an array itself; none where it has no use.
std::vector<std::string> member_names(const NamedColumn& column) {
  if (column.field.kind != NpyKind::kNumber || column.field.shape.size() != 1) return {};
  const std::string name = lower(column.name);
  const std::size_t n = column.field.count;
  if (n == 3 && is_position_name(name)) return {"x", "y", "z"};
  if ((n == 3 || n == 4) && is_one_of(name, {"rgb", "rgba", "color", "colors", "colour", "colours"})) {
    return n == 3 ? std::vector<std::string>{"red", "green", "blue"}
                  : std::vector<std::string>{"red", "green", "blue", "alpha"};
  }
  return {};
}

/// Columns of one number each, where they are of use.
std::vector<NamedColumn> expanded(std::span<const NamedColumn> columns) {
  std::vector<NamedColumn> scalars;
  for (const NamedColumn& column : columns) {
    const std::vector<std::string> names = member_names(column);
    if (names.empty()) scalars.push_back(column);
    for (std::size_t k = 0; k < names.size(); ++k) {
      NamedColumn member = column;
      member.name = names[k];
      member.field.count = 1;
      member.column.data += k * column.field.value_bytes;
      scalars.push_back(std::move(member));
    }
  }
  return scalars;
}

std::vector<Field> fields_of(std::span<const NamedColumn> columns) {
  std::vector<Field> fields;
  for (const NamedColumn& column : columns) {
    const bool number = column.field.kind == NpyKind::kNumber || column.field.kind == NpyKind::kBool;
    fields.push_back(
        {column.name.empty() ? "_" : column.name, column.field.scalar, number ? column.field.count : 2, {}});
  }
  return fields;
}

/// Whether these are the members of a point as LAS stores it, beside its coordinates.
bool has_las_members(std::span<const NamedColumn> columns) {
  return std::any_of(columns.begin(), columns.end(), [](const NamedColumn& column) {
    return is_one_of(lower(column.name), {"bit_fields", "raw_classification", "classification", "classification_flags",
                                          "return_number", "number_of_returns", "scan_angle", "scan_angle_rank",
                                          "user_data", "point_source_id", "gps_time", "intensity"});
  });
}

void check_coordinates(const std::string& name, std::span<const NamedColumn> columns, const PointSchema& schema,
                       FileInfo& info) {
  const auto is_whole = [&](std::size_t i) { return !is_floating(columns[i].field.scalar); };
  const auto& axes = schema.position;
  if (!std::any_of(axes.begin(), axes.end(), is_whole)) return;
  const NamedColumn& first = columns[axes[0]];
  if (first.name == "X" || has_las_members(columns)) {
    throw InputError(
        fmt::format("{}: the coordinates {} {} {} are integers ({}) as LAS stores them, which mean nothing "
                    "without its scale and offset; save the scaled coordinates (laspy: las.xyz), or give the "
                    "LAS file itself",
                    name, first.name, columns[axes[1]].name, columns[axes[2]].name, first.field.type));
  }
  info.notes.push_back(fmt::format("the coordinates are integers ({}), taken as meters as they are", first.field.type));
}

}  // namespace

NpyPoints points_of_columns(const std::string& name, std::span<const NamedColumn> columns, std::uint64_t n,
                            FileInfo& info) {
  const std::vector<NamedColumn> scalars = expanded(columns);
  const std::vector<Field> fields = fields_of(scalars);
  const ByteSource source(name, std::span(columns[0].column.data, 1));  // stands for the array in messages
  const PointSchema schema = find_point_schema(source, fields, info);
  check_coordinates(name, scalars, schema, info);
  NpyPoints points;
  points.n = n;
  points.shape = {n};
  points.layout = schema.layout;
  points.columns.color = schema.layout.color.storage;
  for (std::size_t k = 0; k < 3; ++k) {
    points.columns.position[k] = scalars[schema.position[k]].column;
    points.columns.rgb[k] = scalars[schema.color_fields[k]].column;
  }
  return points;
}

}  // namespace cmap
