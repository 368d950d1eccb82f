#include "cmap/io/transform_file.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "cmap/io/line_reader.hpp"
#include "containers/npy_array.hpp"
#include "poses/transform_numbers.hpp"
#include "poses/written_rotation.hpp"

namespace cmap {
namespace {

using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

constexpr std::uint64_t kMostTransformBytes = std::uint64_t{1} << 20;

std::string read_all(ByteSource& source) {
  if (source.size() > kMostTransformBytes) source.fail("{} bytes are too many for a transform", source.size());
  std::string text(source.size(), '\0');
  source.read(std::as_writable_bytes(std::span(text)), "the file");
  return text;
}

void refuse_other_bytes(const ByteSource& source, std::string_view bytes) {
  if (starts_as_utf16(bytes)) source.fail("is UTF-16 text; save it as UTF-8");
  if (bytes.starts_with("PK")) source.fail("is an archive; numpy.save writes a matrix alone");
  if (bytes.find('\0') != std::string_view::npos) source.fail("is no text, JSON or .npy file");
}

/// What starts with a bracket may be a printed matrix; with quotation marks it was meant to be JSON.
bool is_json(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || (text[first] != '{' && text[first] != '[')) return false;
  return nlohmann::json::accept(text, /*ignore_comments=*/true) || text.find('"') != std::string_view::npos;
}

TransformNumbers read_numbers(ByteSource& source) {
  const std::span<const std::byte> start = source.peek(std::min<std::uint64_t>(6, source.size()));
  if (std::string_view(reinterpret_cast<const char*>(start.data()), start.size()).starts_with("\x93NUMPY")) {
    return transform_from_npy(source);
  }
  const std::string bytes = read_all(source);
  refuse_other_bytes(source, bytes);
  const std::string text(without_byte_order_mark(bytes));
  return is_json(text) ? transform_from_json(source, text) : transform_from_text(source, text);
}

/// What numbers that are no matrix probably are.
[[noreturn]] void refuse(const ByteSource& source, const TransformNumbers& numbers) {
  const std::vector<std::size_t>& rows = numbers.rows;
  const std::size_t n = numbers.values.size();
  const auto all_rows_hold = [&](std::size_t k) {
    return rows.size() > 1 && std::all_of(rows.begin(), rows.end(), [&](std::size_t row) { return row == k; });
  };
  if (all_rows_hold(3) && rows.size() == 4) {
    source.fail("4 rows of 3 numbers; 3 rows of 4 expected (is the matrix column-major? transpose it)");
  }
  if (all_rows_hold(8) || all_rows_hold(12) || all_rows_hold(16)) {
    source.fail("{} rows of {} numbers are the poses of a trajectory; a transform is one 4x4 matrix", rows.size(),
                rows.front());
  }
  if (all_rows_hold(4) && n > 16 && n % 16 == 0) source.fail("{} matrices; a transform is one", n / 16);
  if (n == 7 || n == 8) {
    source.fail("{} numbers, as of a pose with its quaternion, whose order nothing tells; give the 4x4 matrix", n);
  }
  if (n == 9) source.fail("9 numbers, as of a rotation; a transform has 12 or 16, with the translation");
  source.fail("{} numbers; a transform has 16, a 4x4 matrix, or the 12 of its upper rows", n);
}

bool is_last_row(const Eigen::RowVector4d& row) {
  return (row - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kLastRowTolerance;
}

/// Of numbers in a list, the columns may come one after the other: then the translation stands last.
bool is_column_major(const TransformNumbers& numbers, const Eigen::Matrix4d& by_rows) {
  const bool in_rows = std::all_of(numbers.rows.begin(), numbers.rows.end(), [](std::size_t n) { return n == 4; });
  if (in_rows || !is_last_row(by_rows.col(3).transpose())) return false;
  return numbers.column_major || !is_last_row(by_rows.row(3));
}

Eigen::Matrix4d matrix_of(const ByteSource& source, TransformNumbers numbers, std::vector<Warning>& warnings) {
  const bool transposed = numbers.rows == std::vector<std::size_t>(4, 3);
  const bool two_poses = numbers.rows == std::vector<std::size_t>(2, 8);
  if (numbers.values.size() == 12 && !transposed) numbers.values.insert(numbers.values.end(), {0, 0, 0, 1});
  if (numbers.values.size() != 16 || two_poses) refuse(source, numbers);
  const Eigen::Matrix4d matrix = Eigen::Map<const RowMajor>(numbers.values.data());
  if (!is_column_major(numbers, matrix)) return matrix;
  warnings.push_back(
      {"transform_column_major", source.name() + ": its numbers are read column by column (column-major)"});
  return matrix.transpose();
}

void check_similarity(const ByteSource& source, Eigen::Matrix4d& matrix) {
  if (!is_last_row(matrix.row(3))) {
    source.fail("the last row is {:g} {:g} {:g} {:g}; 0 0 0 1 expected (is the matrix column-major? transpose it)",
                matrix(3, 0), matrix(3, 1), matrix(3, 2), matrix(3, 3));
  }
  matrix.row(3) << 0, 0, 0, 1;
  const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
  const double scale = std::cbrt(linear.determinant());
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    source.fail("the determinant of the linear part is {:g}; a rotation times a positive scale expected",
                linear.determinant());
  }
  const double deviation = deviation_from_rotation(linear / scale);
  if (!(deviation <= kRotationTolerance)) {
    source.fail("the linear part deviates by {:g} from a rotation times a scale; {:g} accepted", deviation,
                kRotationTolerance);
  }
}

}  // namespace

TransformNumbers transform_from_npy(ByteSource& source) {
  if (source.size() > kMostTransformBytes) source.fail("{} bytes are too many for a transform", source.size());
  const NpyArray array = read_npy(source);
  std::vector<std::uint64_t> shape = array.shape();
  while (shape.size() > 1 && shape.front() == 1) shape.erase(shape.begin());
  if (shape.size() == 3 && shape[1] * shape[2] <= 16) source.fail("{} matrices; a transform is one", shape[0]);
  if (shape.empty() || shape.size() > 2)
    source.fail("an array of shape {}; (4, 4) expected", shape_text(array.shape()));
  const Array<double> values = array.to_doubles();
  TransformNumbers numbers{{values.begin(), values.end()}, {}, false};
  numbers.rows.assign(shape.size() == 1 ? 1 : shape[0], shape.back());
  return numbers;
}

TransformFile parse_transform(ByteSource& source) {
  TransformFile file;
  TransformNumbers numbers = read_numbers(source);
  for (const double value : numbers.values) {
    if (!std::isfinite(value)) source.fail("a number of the matrix is not finite");
  }
  file.T = matrix_of(source, std::move(numbers), file.warnings);
  check_similarity(source, file.T);
  return file;
}

TransformFile read_transform(const std::filesystem::path& path) {
  ByteSource source(path);
  return parse_transform(source);
}

std::string transform_text(const Eigen::Matrix4d& T) {
  std::string text;
  for (Eigen::Index row = 0; row < 4; ++row) {
    text += fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}\n", T(row, 0), T(row, 1), T(row, 2), T(row, 3));
  }
  return text;
}

nlohmann::ordered_json transform_json(const Eigen::Matrix4d& T) {
  auto rows = nlohmann::ordered_json::array();
  for (Eigen::Index row = 0; row < 4; ++row) rows.push_back({T(row, 0), T(row, 1), T(row, 2), T(row, 3)});
  return rows;
}

}  // namespace cmap
