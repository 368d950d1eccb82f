#include "clouds/numpy/npy_points.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "clouds/unnamed_columns.hpp"
#include "containers/npy_shape.hpp"

namespace cmap {
namespace {

void note(const NpyArray& array, std::string text, FileInfo& info) {
  info.notes.push_back(array.label.empty() ? std::move(text) : fmt::format("{}: {}", array.label, text));
}

double number_at(const std::byte* place, ScalarType type) {
  return visit_scalar(type, [&]<class T>(T value) {
    std::copy_n(place, sizeof(T), reinterpret_cast<std::byte*>(&value));
    return static_cast<double>(value);
  });
}

/// Rows at equal distances.
NumberTable sample_of(const NpyArray& array, const PointTable& table, ScalarType type) {
  constexpr std::uint64_t kMostRows = 20000;
  const std::uint64_t step = (table.rows - 1) / kMostRows + 1;
  const std::size_t bytes = scalar_bytes(type);
  NumberTable sample{table.columns, {}, static_cast<double>(step)};
  for (std::uint64_t row = 0; row < table.rows; row += step) {
    for (std::size_t j = 0; j < table.columns; ++j) {
      const std::size_t place = table.column_offset(j, bytes) + row * table.stride(bytes);
      sample.values.push_back(number_at(array.bytes.data() + place, type));
    }
  }
  return sample;
}

/// Whether a unit quaternion stands in the last four columns, behind x y z or behind a time, x y z. Black with an alpha
/// of one is none, nor is a normal with a curvature of nearly zero.
bool are_poses(const NumberTable& sample) {
  constexpr double kTolerance = 1e-3;
  if (sample.columns != 7 && sample.columns != 8) return false;
  const bool timed = sample.columns == 8;
  const std::size_t first = sample.columns - 4;
  bool all_identity = true, all_normals = true;
  for (std::size_t row = 0; row < sample.rows(); ++row) {
    const Eigen::Map<const Eigen::Vector4d> q(&sample.values[row * sample.columns + first]);
    if (!(std::abs(q.norm() - 1.0) < kTolerance)) return false;
    if (timed && row > 0 && !(sample.at(row, 0) > sample.at(row - 1, 0))) return false;
    all_identity = all_identity && q[3] == 1.0;
    all_normals = all_normals && q[3] >= 0.0 && std::abs(q.head<3>().norm() - 1.0) < kTolerance;
  }
  return !all_normals && (timed || !all_identity);
}

void note_shape(const NpyArray& array, const PointTable& table, FileInfo& info) {
  if (table.transposed) {
    note(array,
         fmt::format("{} rows of {} numbers taken as {} points (transposed)", table.columns, table.rows, table.rows),
         info);
  }
  const NpyField& values = array.header.fields[0];
  if (is_floating(values.scalar)) return;
  note(array,
       fmt::format(
           "the coordinates are integers ({}), taken as meters as they are; raw integers of LAS would need their "
           "scale and offset",
           values.type),
       info);
}

NpyPoints plain_points(const NpyArray& array, FileInfo& info) {
  const PointTable table = require_point_table(array);
  const ScalarType type = array.header.fields[0].scalar;
  const std::size_t bytes = scalar_bytes(type);
  const auto column = [&](std::size_t j) {
    return Column{array.bytes.data() + table.column_offset(j, bytes), table.stride(bytes), type};
  };
  note_shape(array, table, info);
  NpyPoints points;
  points.n = table.rows;
  points.shape = table.transposed ? std::vector{table.rows} : array.shape();
  if (!table.transposed) points.shape.pop_back();
  points.layout.wide = type != ScalarType::kFloat32;
  for (std::size_t k = 0; k < 3; ++k) points.columns.position[k] = column(k);
  if (table.columns == 3) return points;
  const NumberTable sample = sample_of(array, table, type);
  if (are_poses(sample)) {
    array.fail("has the shape {}: positions and unit quaternions, a trajectory and no points",
               shape_text(array.shape()));
  }
  // Whole numbers throughout are cells of a grid: x as well as anything.
  const std::size_t first = find_row_numbers(sample) == RowNumbers::kCertain ? 1 : 0;
  if (first > 0) {
    note(array, "column 0 numbers the rows; columns 1 to 3 taken as x, y and z", info);
    for (std::size_t k = 0; k < 3; ++k) points.columns.position[k] = column(k + first);
  }
  if (const auto color = find_unnamed_colors(first > 0 ? without_first_column(sample) : sample, false, info)) {
    set_colors(points, {column(first + (*color)[0]), column(first + (*color)[1]), column(first + (*color)[2])});
  }
  return points;
}

}  // namespace

NpyPoints points_of(const NpyArray& array, FileInfo& info) {
  if (!array.header.is_record()) return plain_points(array, info);
  if (array.size() == 0) array.fail("holds no points: its shape is {}", shape_text(array.shape()));
  std::vector<NamedColumn> columns;
  for (const NpyField& field : array.header.fields) {
    columns.push_back({field.name, field, {array.bytes.data() + field.offset, array.header.item_bytes, field.scalar}});
  }
  NpyPoints points = points_of_columns(array.name, columns, array.size(), info);
  points.shape = array.shape();
  return points;
}

void set_colors(NpyPoints& points, const std::array<Column, 3>& rgb) {
  const bool same = rgb[0].type == rgb[1].type && rgb[0].type == rgb[2].type;
  points.columns.rgb = rgb;
  points.columns.color = points.layout.color.storage = ColorStorage::kSeparate;
  points.layout.color.type = same ? std::optional(rgb[0].type) : std::nullopt;
}

void append_points(const NpyPoints& points, std::uint64_t first, std::uint64_t last, CloudBuilder& builder) {
  const std::uint64_t frame_points = points.frame_points == 0 ? points.n : points.frame_points;
  while (first < last) {
    const std::uint64_t frame = first / frame_points, in_frame = first % frame_points;
    const std::uint64_t n = std::min(last - first, frame_points - in_frame);
    PointColumns columns = points.columns;
    for (std::size_t k = 0; k < 3; ++k) {
      columns.position[k].data += first * columns.position[k].stride;
      if (points.has_color()) {
        columns.rgb[k].data += frame * points.frame_color_bytes + in_frame * columns.rgb[k].stride;
      }
    }
    builder.append(columns, n);
    first += n;
  }
}

}  // namespace cmap
