#include "containers/npy_shape.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "poses/written_rotation.hpp"

namespace cmap {
namespace {

using Shape = std::vector<std::uint64_t>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::uint64_t kMostColumns = 9;  // x y z, colors and normals
constexpr std::string_view kExpected = "(N, 3), or (N, 4) to (N, 9) with more after x y z, expected of points";

bool may_be_columns(std::uint64_t n) { return n >= 3 && n <= kMostColumns; }

[[noreturn]] void fail_shape(const NpyArray& array, std::string_view what) {
  array.fail("has the shape {}, {}; {}", shape_text(array.shape()), what, kExpected);
}

/// The matrices that the last two dimensions make, as far as there is any doubt.
std::vector<Matrix> matrices_of(const NpyArray& array, Eigen::Index rows, Eigen::Index columns) {
  constexpr std::size_t kMost = 64;
  const Array<double> values = array.to_doubles();
  const auto size = static_cast<std::size_t>(rows * columns);
  std::vector<Matrix> matrices;
  for (std::size_t i = 0; (i + 1) * size <= values.size() && i < kMost; ++i) {
    matrices.emplace_back(Eigen::Map<const Matrix>(values.data() + i * size, rows, columns));
  }
  return matrices;
}

/// A rotation (and scale) in the first three rows and columns.
bool is_rotation_block(const Matrix& matrix) {
  const Eigen::Matrix3d block = matrix.topLeftCorner<3, 3>();
  const double scale = block.row(0).norm();
  return scale > 0.0 && deviation_from_rotation(block / scale) <= kRotationTolerance;
}

/// [fx s cx; 0 fy cy; 0 0 1]
bool is_camera_matrix(const Matrix& matrix) {
  return matrix(0, 0) > 0.0 && matrix(1, 1) > 0.0 && matrix(1, 0) == 0.0 &&
         (matrix.row(2) - Eigen::RowVector3d(0, 0, 1)).cwiseAbs().maxCoeff() <= kLastRowTolerance;
}

bool is_transform_matrix(const Matrix& matrix) {
  return (matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kLastRowTolerance;
}

/// Refuses (..., 3, 3), (..., 3, 4) and (..., 4, 4) where they are matrices and not points.
void refuse_matrices(const NpyArray& array) {
  const Shape& shape = array.shape();
  const std::size_t n = shape.size();
  if (n < 2 || array.size() == 0) return;
  const std::uint64_t rows = shape[n - 2], columns = shape[n - 1];
  if ((rows != 3 && rows != 4) || (columns != 3 && columns != 4) || rows > columns) return;
  const auto matrices = matrices_of(array, static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  const auto all = [&](auto&& test) { return std::all_of(matrices.begin(), matrices.end(), test); };
  const std::string_view several = n == 2 ? "a " : "";
  const std::string_view plural = n == 2 ? "" : "s";
  // Four points may end with 0 0 0 1.
  if (rows == 4 && all(is_transform_matrix) && (n > 2 || all(is_rotation_block))) {
    fail_shape(array, fmt::format("{}4x4 transform{}, no points", several, plural));
  }
  if (rows == 3 && columns == 3 && (all(is_rotation_block) || all(is_camera_matrix))) {
    fail_shape(array, fmt::format("{}3x3 rotation or camera matri{}, no points", several, n == 2 ? "x" : "ces"));
  }
  if (rows == 3 && columns == 4 && (n > 2 || all(is_rotation_block))) {
    fail_shape(array, fmt::format("{}3x4 pose or projection matri{}, no points", several, n == 2 ? "x" : "ces"));
  }
}

void refuse_types(const NpyArray& array) {
  const NpyField& values = array.header.fields[0];
  if (values.kind == NpyKind::kBool) fail_shape(array, "truth values (|b1)");
  if (values.kind != NpyKind::kNumber) {
    array.fail("values of type '{}' of shape {}; numbers (f2, f4, f8 or integers) expected of points", values.type,
               shape_text(array.shape()));
  }
  const bool picture = values.scalar == ScalarType::kUint16 && array.shape().size() > 2;
  if (values.scalar == ScalarType::kUint8 || picture) {
    fail_shape(array, fmt::format("values of type {}: colors or pictures", values.type));
  }
}

/// What an array is that is no table of points.
[[noreturn]] void refuse_shape(const NpyArray& array) {
  const Shape& shape = array.shape();
  if (shape.size() < 2) fail_shape(array, "one row of numbers");
  if (shape.size() == 2 && (shape[1] == 12 || shape[1] == 16)) {
    fail_shape(array, fmt::format("rows of {} numbers, as trajectories have them", shape[1]));
  }
  if (shape.size() == 2 && shape[1] == 2) fail_shape(array, "without a z");
  if (shape.size() == 2 && may_be_columns(shape[0])) {
    fail_shape(array, fmt::format("{} points of {} numbers or {} points transposed", shape[0], shape[1], shape[1]));
  }
  if (shape.size() > 2 && shape[shape.size() - 3] == 3) {
    fail_shape(array, "x, y and z in planes of their own (numpy.moveaxis(a, -3, -1) puts them last)");
  }
  fail_shape(array, "no points");
}

}  // namespace

std::optional<PointTable> find_point_table(const Shape& shape) {
  if (shape.size() < 2 || std::find(shape.begin(), shape.end(), 0U) != shape.end()) return std::nullopt;
  std::uint64_t rows = 1;
  for (std::size_t i = 0; i + 1 < shape.size(); ++i) rows *= shape[i];
  const std::uint64_t columns = shape.back();
  const bool flat = shape.size() == 2;
  if (columns == 3) return PointTable{rows, 3, false};
  if (flat && may_be_columns(rows) && columns > kMostColumns) return PointTable{columns, rows, true};
  // Three points or three rows of coordinates; planes of coordinates.
  const bool ambiguous = flat ? rows == 3 : shape[shape.size() - 3] == 3;
  if (may_be_columns(columns) && !ambiguous) return PointTable{rows, columns, false};
  return std::nullopt;
}

PointTable require_point_table(const NpyArray& array) {
  const Shape& shape = array.shape();
  if (array.size() == 0) array.fail("holds no points: its shape is {}", shape_text(shape));
  refuse_types(array);
  refuse_matrices(array);
  if (shape.size() >= kBatchDimensions && shape.front() > 1) {
    fail_shape(array, fmt::format("a batch of {} scenes; save one of them", shape.front()));
  }
  const auto table = find_point_table(shape);
  if (!table) refuse_shape(array);
  return *table;
}

}  // namespace cmap
