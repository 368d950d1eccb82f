#include "clouds/text/ptx_header.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>

#include "cmap/io/number_text.hpp"
#include "poses/written_rotation.hpp"

namespace cmap {
namespace {

/// The n numbers of the next line of a header.
template <std::size_t n>
std::array<double, n> header_numbers(LineReader& lines, std::string_view what) {
  std::string_view line;
  if (!next_filled_line(lines, line)) lines.fail("truncated: the file ends before {} of a PTX header", what);
  std::array<double, n> values{};
  for (double& value : values) {
    const std::string_view token = next_token(line);
    if (!parse_number(token, value) || !std::isfinite(value)) {
      lines.fail("'{}' is no number of {}, where a PTX header has {}", token.substr(0, 40), what, n);
    }
  }
  if (!next_token(line).empty()) lines.fail("more than the {} numbers of {} of a PTX header", n, what);
  return values;
}

std::uint64_t count_of(const LineReader& lines, std::string_view line, std::string_view what) {
  const std::string_view token = next_token(line);
  unsigned long long count = 0;
  if (!parse_number(token, count) || !next_token(line).empty()) {
    lines.fail("'{}' is not the number of {} of a PTX scan", token.substr(0, 40), what);
  }
  return count;
}

Eigen::Matrix4d read_matrix(LineReader& lines) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    const auto values = header_numbers<4>(lines, "the 4x4 matrix");
    for (int k = 0; k < 4; ++k) matrix(row, k) = values[static_cast<std::size_t>(k)];
  }
  constexpr double kExact = 1e-6;  // of printed digits
  const Eigen::Vector4d last(0, 0, 0, 1);
  if (!matrix.col(3).isApprox(last, kExact)) {
    if (matrix.row(3).isApprox(last.transpose(), kExact)) {
      lines.fail("the matrix has its translation in the last column; PTX has it in the last row");
    }
    lines.fail("the last column of the matrix is not 0 0 0 1");
  }
  if (std::abs(matrix.topLeftCorner<3, 3>().determinant()) < 1e-12) lines.fail("the matrix flattens the scan");
  return matrix;
}

}  // namespace

bool next_filled_line(LineReader& lines, std::string_view& line) {
  while (lines.next(line)) {
    if (line.find_first_not_of(" \t\v\f\r") != std::string_view::npos) return true;
  }
  return false;
}

PtxScan read_ptx_header(LineReader& lines, std::string_view line, std::size_t index, FileInfo& info) {
  PtxScan scan;
  scan.index = index;
  const std::uint64_t columns = count_of(lines, line, "columns");
  if (!next_filled_line(lines, line)) lines.fail("truncated: the file ends before the number of rows of a PTX scan");
  const std::uint64_t rows = count_of(lines, line, "rows");
  if (rows > 0 && columns > std::numeric_limits<std::uint64_t>::max() / rows) {
    lines.fail("a scan of {} columns and {} rows", columns, rows);
  }
  scan.grid_rows = columns * rows;
  scan.sensor = Eigen::Vector3d(header_numbers<3>(lines, "the scanner's position").data());
  for (int axis = 0; axis < 3; ++axis) header_numbers<3>(lines, "the scanner's axes");
  scan.T_rows = read_matrix(lines);
  const double deviation = deviation_from_rotation(scan.T_rows.topLeftCorner<3, 3>().transpose());
  if (!(deviation <= kRotationTolerance)) {
    info.notes.push_back(fmt::format("scan {}: its matrix is no rotation; applied as it is", index));
  }
  // Some writers leave the line of the position at zero.
  if (scan.sensor.isZero(0.0)) scan.sensor = scan.T_rows.row(3).head<3>().transpose();
  return scan;
}

}  // namespace cmap
