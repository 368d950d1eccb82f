#include "clouds/not_a_cloud.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "clouds/point_names.hpp"
#include "poses/written_rotation.hpp"

namespace cmap {
namespace {

using Row = std::vector<double>;
using Rows = std::span<const Row>;

bool all_have(Rows rows, std::size_t n_columns) {
  const auto has_n = [&](const Row& row) { return row.size() == n_columns; };
  return !rows.empty() && std::all_of(rows.begin(), rows.end(), has_n);
}

bool is_last_row(const double* row) {
  const Eigen::Map<const Eigen::Vector4d> last(row);
  return (last - Eigen::Vector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kLastRowTolerance;
}

/// Whether a block is a rotation or a reflection, with a scale or not.
bool is_rotation(const Eigen::Matrix3d& block) {
  const double scale = block.row(0).norm();
  if (!(scale > 1e-6)) return false;
  const Eigen::Matrix3d unit = block / scale;
  return std::min(deviation_from_rotation(unit), deviation_from_rotation(-unit)) <= kRotationTolerance;
}

/// The same of the 3x3 block of a 3x4 matrix, row after row.
bool is_rotation(const double* rows_3x4) {
  using Matrix = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  return is_rotation(Eigen::Matrix3d(Eigen::Map<const Matrix>(rows_3x4).leftCols<3>()));
}

/// The rows one after the other, as one.
Row joined(Rows rows) {
  Row all;
  for (const Row& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

bool is_transform(Rows rows) {
  const Row all = joined(rows);
  if (rows.size() == 4 && all_have(rows, 4)) {
    if (is_last_row(&all[12])) return is_rotation(all.data());
    // The transpose, which moves row vectors.
    const bool last_column = all[3] == 0.0 && all[7] == 0.0 && all[11] == 0.0 && all[15] == 1.0;
    return last_column && is_rotation(all.data());
  }
  if (rows.size() == 3 && all_have(rows, 4)) return is_rotation(all.data());
  return rows.size() == 1 && all.size() == 16 && is_last_row(&all[12]);
}

/// A rotation, or [fx s cx; 0 fy cy; 0 0 1].
bool is_rotation_or_camera(Rows rows) {
  if (rows.size() != 3 || !all_have(rows, 3)) return false;
  const Row all = joined(rows);
  const Eigen::Matrix3d matrix = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(all.data());
  const bool is_camera = matrix(0, 0) > 0.0 && matrix(1, 1) > 0.0 && matrix(1, 0) == 0.0 &&
                         (matrix.row(2) - Eigen::RowVector3d(0, 0, 1)).cwiseAbs().maxCoeff() <= kLastRowTolerance;
  return is_camera || is_rotation(matrix);
}

/// Rows of 12 or 16 numbers, each a matrix.
bool is_pose_rows(Rows rows) {
  if (!all_have(rows, 12) && !all_have(rows, 16)) return false;
  return std::all_of(rows.begin(), rows.end(), [](const Row& row) {
    return is_rotation(row.data()) && (row.size() == 12 || is_last_row(&row[12]));
  });
}

/// 4x4 matrices below each other, a line of other numbers before each or not (Redwood's .log: three of them).
bool is_stacked(Rows rows) {
  if (rows.size() < 4) return false;
  const std::size_t n_before = rows[0].size() == 4 ? 0 : 1;
  const std::size_t period = 4 + n_before;
  for (std::size_t i = 0; i + period <= rows.size(); i += period) {
    const Rows matrix = rows.subspan(i + n_before, 4);
    if (n_before == 1 && rows[i].size() != rows[0].size()) return false;
    if (!all_have(matrix, 4) || !is_last_row(matrix[3].data()) || !is_rotation(joined(matrix).data())) return false;
  }
  return rows.size() >= period;
}

/// Normals with a curvature of nearly zero are of unit length too, and no poses.
bool may_be_normals(const Row& row) {
  const double length = std::hypot(row[4], row[5], row[6]);
  return row[7] >= 0.0 && std::abs(length - 1.0) <= 1e-3;
}

/// TUM's trajectory: times that grow, and unit quaternions in the last four of eight columns.
bool is_tum(Rows rows) {
  if (rows.size() < 2 || !all_have(rows, 8)) return false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Eigen::Map<const Eigen::Vector4d> quaternion(rows[i].data() + 4);
    if (!(std::abs(quaternion.norm() - 1.0) <= 1e-3)) return false;
    if (i > 0 && !(rows[i][0] > rows[i - 1][0])) return false;
  }
  return !std::all_of(rows.begin(), rows.end(), may_be_normals);
}

/// Fewer rows than columns: a cloud in which each row is a coordinate or a channel, several clouds beside each other,
/// a picture. Of three rows, five columns are no layout of points either.
bool is_transposed(Rows rows) {
  constexpr std::size_t kMostOfPoints = 12;  // coordinates, color, normal and three more
  if (rows.empty() || !all_have(rows, rows[0].size())) return false;
  const std::size_t n_columns = rows[0].size();
  if (rows.size() == 3) return n_columns == 5 || n_columns > 6;
  return n_columns > kMostOfPoints && n_columns > rows.size();
}

}  // namespace

std::optional<std::string> not_a_cloud(Rows rows, bool complete) {
  if (rows.empty()) return std::nullopt;
  if (complete && is_transform(rows)) {
    return fmt::format("is a {}x{} matrix, a transform, and no point cloud; --transform takes it",
                       rows.size() == 3 ? 3 : 4, 4);
  }
  if (complete && is_rotation_or_camera(rows)) return "is a 3x3 rotation or camera matrix, and no point cloud";
  if (is_pose_rows(rows)) {
    return fmt::format("holds poses (rows of {} numbers, each a {}x4 matrix), not points: a trajectory", rows[0].size(),
                       rows[0].size() / 4);
  }
  if (is_stacked(rows)) return "holds poses (4x4 matrices below each other), not points: a trajectory";
  if (is_tum(rows)) return std::string(pose_hint());
  if (complete && is_transposed(rows)) {
    return fmt::format(
        "holds {} row{} of {} numbers: a transposed cloud, or several things beside each other; write one "
        "cloud a file, one point a line, or name the columns (x y z ...)",
        rows.size(), rows.size() == 1 ? "" : "s", rows[0].size());
  }
  return std::nullopt;
}

bool names_poses(std::span<const std::string> names) {
  if (names.empty()) return false;
  const std::string first = plain_name(names[0]);
  if (!first.starts_with("time") && !first.starts_with("stamp") && first != "t") return false;
  const auto is_there = [&](std::string_view wanted) {
    return std::any_of(names.begin(), names.end(), [&](const auto& name) { return plain_name(name) == wanted; });
  };
  return is_there("qx") && is_there("qy") && is_there("qz") && is_there("qw");
}

std::string_view pose_hint() {
  return "holds poses (time x y z qx qy qz qw, TUM's layout), not points; cmap_align --method trajectory takes "
         "them, and cmap_eval --ref-trajectory and --est-trajectory";
}

}  // namespace cmap
