#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bytes/ascii_rows.hpp"
#include "clouds/cloud_format.hpp"
#include "clouds/text/ptx_header.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// No scanner sees farther; one whose nearest point is, is not where its header says.
constexpr double kFarthestView_m = 10'000.0;

/// What was found of a scan.
struct ScanRows {
  std::uint64_t n = 0;
  std::uint64_t n_beyond = 0;                                      ///< after the last of the grid
  double nearest_sq_m2 = std::numeric_limits<double>::infinity();  ///< from the scanner to a point
};

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
  bool read_scan(const PtxScan& scan, ScanRows& rows, std::string_view& line) {
    while (next_filled_line(lines_, line)) {
      std::array<double, 7> values{};
      const std::size_t n = parse(line, values);
      if (n == 1) return true;
      if (n != 4 && n != 7) lines_.fail("{} columns; x y z intensity [r g b] expected of a PTX scan", n);
      if (rows.n == scan.grid_rows) {
        ++rows.n_beyond;
      } else {
        ++rows.n;
        add(scan, rows, values, n == 7);
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

  void add(const PtxScan& scan, ScanRows& rows, const std::array<double, 7>& values, bool colored) {
    const Eigen::Vector3d in_scan(values.data());
    if (in_scan.isZero(0.0)) {
      ++n_no_return_;
      return;
    }
    const Eigen::Vector3d in_world =
        scan.T_rows.topLeftCorner<3, 3>().transpose() * in_scan + scan.T_rows.row(3).head<3>().transpose();
    rows.nearest_sq_m2 = std::fmin(rows.nearest_sq_m2, (in_world - scan.sensor).squaredNorm());
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

void report(const PtxScan& scan, const ScanRows& rows, FileInfo& info) {
  if (rows.n < scan.grid_rows) {
    info.warnings.push_back({"fewer_rows", fmt::format("PTX scan {} holds {} rows, fewer than the {} of its grid: an "
                                                       "export without empty cells, or the file is incomplete",
                                                       scan.index, rows.n, scan.grid_rows)});
  }
  if (rows.n_beyond > 0) {
    info.warnings.push_back({"more_rows", fmt::format("PTX scan {}: {} more rows than the {} of its grid are not used",
                                                      scan.index, rows.n_beyond, scan.grid_rows)});
  }
  if (rows.nearest_sq_m2 <= kFarthestView_m * kFarthestView_m) {
    info.sensor_positions.push_back(scan.sensor);
  } else if (std::isfinite(rows.nearest_sq_m2)) {
    info.notes.push_back(
        fmt::format("scan {}: its scanner is not known (the header's place is far from all points)", scan.index));
  }
}

/// Whether a line near the start has colors.
bool has_colors(const FileStart& start) {
  const auto lines = start.lines(FileStart::kBytes);
  return std::any_of(lines.begin(), lines.end(), [](std::string_view line) { return tokens_of(line, 8).size() == 7; });
}

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
  if (start.extension == ".ptx") return rows.size() == 1 || rows[1].size() == 1;
  return is_count(1) && rows.size() > 2 && rows[2].size() == 3;
}

PointCloud read_ptx(ByteSource& source, FileInfo& info) {
  info.format = "PTX";
  const bool has_color = has_colors(file_start(source));
  LineReader lines(source);
  PtxRows points(lines, has_color);
  std::string_view line;
  bool more = next_filled_line(lines, line);
  for (std::size_t index = 1; more; ++index) {
    const PtxScan scan = read_ptx_header(lines, line, index, info);
    ScanRows rows;
    more = points.read_scan(scan, rows, line);
    report(scan, rows, info);
    if (index > 1) info.format = fmt::format("PTX, {} scans", index);
  }
  return points.finish(info);
}

}  // namespace

namespace formats {

extern constinit const CloudFormat ptx{
    .name = "PTX", .listed = "PTX", .by_content = is_ptx, .read = without_options<read_ptx>};

}  // namespace formats

}  // namespace cmap
