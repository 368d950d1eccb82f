#include "poses/trajectory_rows.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cmap/io/number_text.hpp"
#include "poses/written_rotation.hpp"

namespace cmap {
namespace {

/// Shorter ones have no direction that their digits could give.
constexpr double kShortestQuaternion = 1e-6;

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

StampedPose pose_of_matrix(const LineReader& lines, const std::vector<double>& v) {
  const Matrix34 matrix = Eigen::Map<const Matrix34>(v.data());
  if (v.size() == 16) {
    const Eigen::RowVector4d last(v[12], v[13], v[14], v[15] - 1.0);
    if (!(last.cwiseAbs().maxCoeff() <= kLastRowTolerance)) lines.fail("the last row of the matrix is not 0 0 0 1");
  }
  const double deviation = deviation_from_rotation(matrix.leftCols<3>());
  if (!(deviation <= kRotationTolerance)) {
    lines.fail("the matrix deviates by {:g} from a rotation; {:g} accepted", deviation, kRotationTolerance);
  }
  return {0.0, matrix.col(3), Eigen::Quaterniond(nearest_rotation(matrix.leftCols<3>()))};
}

/// Adds the pose of these values (see TrajectoryLayout), or counts why it is none.
void add(const LineReader& lines, double time, const std::vector<double>& v, TrajectoryRows& rows) {
  ++rows.n_rows;
  bool finite = std::isfinite(time);
  for (const double value : v) finite = finite && std::isfinite(value);
  if (!finite) {
    ++rows.n_not_finite;
    return;
  }
  StampedPose pose;
  if (v.size() == 7) {
    pose = {0.0, {v[0], v[1], v[2]}, Eigen::Quaterniond(v[6], v[3], v[4], v[5])};
    const double length = pose.rotation.norm();
    if (!(length > kShortestQuaternion)) {
      ++rows.n_zero_rotation;
      return;
    }
    pose.rotation.coeffs() /= length;
  } else {
    pose = pose_of_matrix(lines, v);
  }
  pose.time_s = time;
  rows.poses.push_back(pose);
}

void require_columns(const RowReader& reader, std::size_t columns) {
  if (reader.cells().size() == columns) return;
  reader.lines().fail("{} numbers; the poses of this file have {}", reader.cells().size(), columns);
}

void read_rows(RowReader& reader, const TrajectoryLayout& layout, TrajectoryRows& rows) {
  std::vector<double> values(layout.pose.size());
  do {
    require_columns(reader, layout.columns);
    double time = layout.time ? reader.number(*layout.time) : static_cast<double>(rows.n_rows);
    if (layout.nanoseconds) time += 1e-9 * reader.number(*layout.nanoseconds);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = reader.number(layout.pose[i]);
    add(reader.lines(), time, values, rows);
  } while (reader.next());
}

/// COLMAP's and Open3D's .log: a line of three whole numbers before the four rows of each matrix.
void read_log(RowReader& reader, TrajectoryRows& rows) {
  std::vector<double> values(16);
  do {
    require_columns(reader, 3);
    if (reader.number(0) != reader.number(1)) {
      reader.lines().fail("a .log of pairs ({:g} and {:g}), not of poses", reader.number(0), reader.number(1));
    }
    for (std::size_t row = 0; row < 4; ++row) {
      if (!reader.next()) reader.lines().fail("the file ends within a matrix");
      require_columns(reader, 4);
      for (std::size_t column = 0; column < 4; ++column) values[4 * row + column] = reader.number(column);
    }
    add(reader.lines(), static_cast<double>(rows.n_rows), values, rows);
  } while (reader.next());
}

bool is_number(std::string_view cell) {
  double ignored = 0.0;
  return parse_number(cell, ignored);
}

/// A name stands where a row would begin with its first number.
bool is_header(const RowReader& reader) {
  // pandas leaves the name of its index empty.
  const auto named =
      std::find_if(reader.cells().begin(), reader.cells().end(), [](auto cell) { return !cell.empty(); });
  if (named == reader.cells().end() || is_number(*named)) return false;
  const std::string_view first = *named;
  return std::isalpha(static_cast<unsigned char>(first.front())) != 0 || first.front() == '_';
}

TrajectoryLayout layout_of(RowReader& reader) {
  if (is_header(reader)) {
    const std::string header(reader.line());
    if (!reader.next()) reader.lines().fail("no pose follows the header line");
    if (auto layout = trajectory_layout_by_names(reader.lines(), header, reader.cells().size())) return *layout;
    reader.lines().fail("the header line '{}' does not name the {} columns: time, x, y, z, qx, qy, qz and qw expected",
                        header.substr(0, 80), reader.cells().size());
  }
  if (auto layout = trajectory_layout_by_names(reader.lines(), reader.comment(), reader.cells().size())) return *layout;
  return trajectory_layout_by_count(reader);
}

/// "1 0.9 0.1 0.2 0.3 1.5 2.5 3.5 1 00001.png".
bool is_colmap_image(const RowReader& reader) {
  return reader.cells().size() == 10 && is_number(reader.cells()[8]) && !is_number(reader.cells()[9]);
}

/// "0 0 1".
bool starts_log(const RowReader& reader) {
  const auto is_whole = [](std::string_view cell) {
    return !cell.empty() && cell.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return reader.cells().size() == 3 && std::all_of(reader.cells().begin(), reader.cells().end(), is_whole);
}

}  // namespace

TrajectoryRows read_trajectory_rows(ByteSource& source) {
  refuse_other_than_poses(source);
  RowReader reader(source);
  if (!reader.next()) source.fail("no pose in the file");
  TrajectoryRows rows;
  if (is_colmap_image(reader)) source.fail("is COLMAP's images.txt: images without times; write their poses as TUM");
  if (starts_log(reader)) {
    rows.has_times = false;
    read_log(reader, rows);
    return rows;
  }
  const TrajectoryLayout layout = layout_of(reader);
  rows.has_times = layout.time.has_value();
  rows.units_per_s = layout.units_per_s;
  rows.assumed_order = !layout.is_named && layout.columns == 8 && reader.format().separator == ',';
  rows.decimal_comma = reader.format().decimal_comma;
  read_rows(reader, layout, rows);
  return rows;
}

}  // namespace cmap
