#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/ascii_rows.hpp"
#include "io/format_readers.hpp"
#include "io/number_text.hpp"
#include "io/rotation_check.hpp"

namespace cmap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// No scanner sees farther; one whose nearest point is, is not where its header says.
constexpr double kFarthestView_m = 10'000.0;

struct Scan {
  std::size_t index = 0;        ///< in the file, from 1
  std::uint64_t grid_rows = 0;  ///< lines announced: columns times rows
  Eigen::Vector3d sensor;
  Eigen::Matrix4d T_rows;  ///< moves row vectors: (x y z 1) * T_rows
  std::uint64_t n_rows = 0;
  std::uint64_t n_beyond = 0;  ///< rows after the last of the grid
  double nearest_sq_m2 = std::numeric_limits<double>::infinity();
};

bool next_filled(LineReader& lines, std::string_view& line) {
  while (lines.next(line)) {
    if (line.find_first_not_of(" \t\v\f\r") != std::string_view::npos) return true;
  }
  return false;
}

/// The n numbers of the next line of a header.
template <std::size_t n>
std::array<double, n> header_numbers(LineReader& lines, std::string_view what) {
  std::string_view line;
  if (!next_filled(lines, line)) lines.fail("truncated: the file ends before {} of a PTX header", what);
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
  const Eigen::Vector4d last(0, 0, 0, 1);
  if (!matrix.col(3).isApprox(last, 1e-9)) {
    if (matrix.row(3).isApprox(last.transpose(), 1e-9)) {
      lines.fail("the matrix has its translation in the last column; PTX has it in the last row");
    }
    lines.fail("the last column of the matrix is not 0 0 0 1");
  }
  if (std::abs(matrix.topLeftCorner<3, 3>().determinant()) < 1e-12) lines.fail("the matrix flattens the scan");
  return matrix;
}

/// The header whose first line is `line`.
Scan read_scan_header(LineReader& lines, std::string_view line, std::size_t index, FileInfo& info) {
  Scan scan;
  scan.index = index;
  const std::uint64_t columns = count_of(lines, line, "columns");
  if (!next_filled(lines, line)) lines.fail("truncated: the file ends before the number of rows of a PTX scan");
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

/// Takes the lines of scans into a cloud.
class PtxRows {
 public:
  PtxRows(LineReader& lines, bool has_color)
      : lines_(lines),
        has_color_(has_color),
        // Each row takes four digits and four separators at least.
        builder_(lines.source(), {true, {has_color ? ColorStorage::kSeparate : ColorStorage::kNone}},
                 lines.source().size() / 8 + 1),
        stage_(builder_, has_color) {}

  /// Reads up to the next header, whose first line is then in `line`; false at the end of the file.
  bool read_scan(Scan& scan, std::string_view& line) {
    while (next_filled(lines_, line)) {
      std::array<double, 7> values{};
      const std::size_t n = parse(line, values);
      if (n == 1) return true;
      if (n != 4 && n != 7) lines_.fail("{} columns; x y z intensity [r g b] expected of a PTX scan", n);
      if (scan.n_rows == scan.grid_rows) {
        ++scan.n_beyond;
      } else {
        ++scan.n_rows;
        add(scan, values, n == 7);
      }
    }
    return false;
  }

  PointCloud finish(FileInfo& info) {
    stage_.flush();
    builder_.leave_out("no return (exactly at 0 0 0)", n_no_return_);
    if (n_colors_ignored_ > 0) {
      info.notes.push_back(fmt::format("colors of {} points not used: the first scan has none", n_colors_ignored_));
    }
    return builder_.finish(info);
  }

 private:
  /// The numbers of a line, at most 8 counted.
  std::size_t parse(std::string_view line, std::array<double, 7>& values) const {
    std::size_t n = 0;
    for (std::string_view token = next_token(line); !token.empty() && n <= values.size(); token = next_token(line)) {
      if (n < values.size() && !parse_number(token, values[n])) {
        lines_.fail("column {}: '{}' is not a number", n + 1, token.substr(0, 40));
      }
      ++n;
    }
    return n;
  }

  void add(Scan& scan, const std::array<double, 7>& values, bool colored) {
    const Eigen::Vector3d in_scan(values.data());
    if (in_scan.isZero(0.0)) {
      ++n_no_return_;
      return;
    }
    const Eigen::Vector3d in_world =
        scan.T_rows.topLeftCorner<3, 3>().transpose() * in_scan + scan.T_rows.row(3).head<3>().transpose();
    scan.nearest_sq_m2 = std::fmin(scan.nearest_sq_m2, (in_world - scan.sensor).squaredNorm());
    RowStage::Row row{{in_world.x(), in_world.y(), in_world.z()}, {kNaN, kNaN, kNaN}};
    if (colored) std::copy_n(values.begin() + 4, 3, row.rgb.begin());
    if (colored && !has_color_) ++n_colors_ignored_;
    stage_.add(row);
  }

  LineReader& lines_;
  bool has_color_;
  CloudBuilder builder_;
  RowStage stage_;
  std::uint64_t n_no_return_ = 0;
  std::uint64_t n_colors_ignored_ = 0;
};

void report(const Scan& scan, FileInfo& info) {
  if (scan.n_rows < scan.grid_rows) {
    info.warnings.push_back({"fewer_rows", fmt::format("PTX scan {} holds {} rows, fewer than the {} of its grid: an "
                                                       "export without empty cells, or the file is incomplete",
                                                       scan.index, scan.n_rows, scan.grid_rows)});
  }
  if (scan.n_beyond > 0) {
    info.warnings.push_back({"more_rows", fmt::format("PTX scan {}: {} more rows than the {} of its grid are not used",
                                                      scan.index, scan.n_beyond, scan.grid_rows)});
  }
  if (scan.nearest_sq_m2 <= kFarthestView_m * kFarthestView_m) {
    info.sensor_positions.push_back(scan.sensor);
  } else if (scan.n_rows > 0) {
    info.notes.push_back(fmt::format("scan {}: its scanner is not known (the header's place is far from all points)",
                                     scan.index));
  }
}

/// Whether a line near the start has colors.
bool has_colors(const FileStart& start) {
  const auto lines = start.lines(FileStart::kBytes);
  return std::any_of(lines.begin(), lines.end(), [](std::string_view line) { return tokens_of(line, 8).size() == 7; });
}

}  // namespace

/// Two lines of one count each; then the scanner's position.
bool is_ptx(const FileStart& start) {
  if (!start.text) return false;
  std::vector<std::vector<std::string_view>> rows;
  for (const std::string_view line : start.lines(20)) {
    if (auto tokens = tokens_of(line, 8); !tokens.empty()) rows.push_back(std::move(tokens));
  }
  const auto is_count = [&](std::size_t i) {
    unsigned long long count = 0;
    return rows.size() > i && rows[i].size() == 1 && parse_number(rows[i][0], count);
  };
  if (!is_count(0)) return false;
  if (start.extension == ".ptx") return rows.size() == 1 || is_count(1);
  return is_count(1) && rows.size() > 2 && rows[2].size() == 3;
}

PointCloud read_ptx(ByteSource& source, FileInfo& info) {
  info.format = "PTX";
  const bool has_color = has_colors(file_start(source));
  LineReader lines(source);
  PtxRows rows(lines, has_color);
  std::string_view line;
  bool more = next_filled(lines, line);
  for (std::size_t index = 1; more; ++index) {
    Scan scan = read_scan_header(lines, line, index, info);
    more = rows.read_scan(scan, line);
    report(scan, info);
  }
  if (info.sensor_positions.size() > 1) info.format = fmt::format("PTX, {} scans", info.sensor_positions.size());
  return rows.finish(info);
}

}  // namespace cmap
