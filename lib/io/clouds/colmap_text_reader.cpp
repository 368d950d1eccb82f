#include <algorithm>
#include <cmath>
#include <set>

#include "bytes/ascii_rows.hpp"
#include "clouds/cloud_format.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

constexpr std::size_t kRowValues = 8;  // POINT3D_ID X Y Z R G B ERROR; then the track

bool is_comment(std::string_view line) { return line.starts_with('#'); }

/// POINT3D_ID X Y Z R G B ERROR of a line; `track` is what follows. False if this is something else.
bool parse_point(std::string_view line, unsigned long long& id, RowStage::Row& row, std::string_view& track) {
  if (!parse_number(next_token(line), id)) return false;
  for (double& value : row.xyz) {
    if (!parse_number(next_token(line), value)) return false;
  }
  for (double& value : row.rgb) {
    unsigned long long channel = 0;
    if (!parse_number(next_token(line), channel) || channel > 255) return false;
    value = static_cast<double>(channel);
  }
  double error_px = 0.0;
  if (!parse_number(next_token(line), error_px)) return false;
  track = line;
  return true;
}

/// How many numbers a track holds; false if it holds anything but whole numbers.
bool count_track(std::string_view track, std::size_t& n) {
  n = 0;
  for (std::string_view token = next_token(track); !token.empty(); token = next_token(track)) {
    unsigned long long value = 0;
    if (!parse_number(token, value)) return false;
    ++n;
  }
  return true;
}

/// The announced number of points in "# Number of points: 12, mean track length: 3".
bool announced_points(std::string_view comment, unsigned long long& n) {
  constexpr std::string_view kMark = "Number of points:";
  const std::size_t place = comment.find(kMark);
  if (place == std::string_view::npos) return false;
  comment.remove_prefix(place + kMark.size());
  while (!comment.empty() && is_blank(comment.front())) comment.remove_prefix(1);
  return parse_number(comment.substr(0, comment.find_first_not_of("0123456789")), n);
}

/// Points without the comment of their names: all lines must fit, the ids differ, and the tracks be more than chance.
bool rows_fit(const FileStart& start) {
  constexpr std::size_t kLooked = 200;
  std::set<unsigned long long> ids;
  std::size_t n_fraction = 0;
  std::size_t n_track = 0;
  for (const std::string_view line : start.lines(kLooked)) {
    if (is_comment(line) || tokens_of(line, 1).empty()) continue;
    unsigned long long id = 0;
    RowStage::Row row{};
    std::string_view track;
    std::size_t n = 0;
    if (!parse_point(line, id, row, track) || !count_track(track, n) || n % 2 != 0 || !ids.insert(id).second) {
      return false;
    }
    n_fraction += std::any_of(row.xyz.begin(), row.xyz.end(), [](double v) { return v != std::trunc(v); }) ? 1 : 0;
    n_track += n;
  }
  if (ids.empty()) return false;
  if (start.name.starts_with("points3d")) return true;
  return ids.size() >= 3 && n_fraction > 0 && n_track >= 2 * ids.size();
}

bool is_colmap_text(const FileStart& start) {
  if (!start.text) return false;
  for (const std::string_view line : start.lines(10)) {
    if (!is_comment(line)) break;
    if (line.find("3D point list with one line of data per point") != std::string_view::npos) return true;
    if (line.find("POINT3D_ID") != std::string_view::npos && line.find("TRACK") != std::string_view::npos &&
        line.find("POINTS2D") == std::string_view::npos) {
      return true;
    }
  }
  return rows_fit(start);
}

PointCloud read_colmap_text(ByteSource& source, FileInfo& info) {
  info.format = "COLMAP points3D text";
  LineReader lines(source);
  // Each of the values takes a digit and a separator at least.
  const std::uint64_t max_points = source.size() / (2 * kRowValues) + 1;
  CloudBuilder builder(source, {true, {ColorStorage::kSeparate, ScalarType::kUint8}}, max_points);
  RowStage stage(builder, true);
  unsigned long long n_announced = 0;
  bool announced = false;
  std::uint64_t n_points = 0;
  std::string_view line;
  while (lines.next(line)) {
    if (is_comment(line)) {
      announced = announced_points(line, n_announced) || announced;
      continue;
    }
    if (tokens_of(line, 1).empty()) continue;
    unsigned long long id = 0;
    RowStage::Row row{};
    std::string_view track;
    if (!parse_point(line, id, row, track)) {
      lines.fail("not a COLMAP point: POINT3D_ID X Y Z R G B ERROR TRACK[] expected, with R G B from 0 to 255");
    }
    std::size_t n_track = 0;
    if (!count_track(track, n_track)) lines.fail("the track of point {} holds more than whole numbers", id);
    if (n_track % 2 != 0) lines.fail("the track of point {} has {} numbers, not pairs", id, n_track);
    stage.add(row);
    ++n_points;
  }
  stage.flush();
  if (announced && n_points != n_announced) {
    info.warnings.push_back({"point_count", fmt::format("the comment counts {} points, the file holds {}: incomplete, "
                                                        "or edited",
                                                        n_announced, n_points)});
  }
  return builder.finish(info);
}

}  // namespace

namespace formats {

extern constinit const CloudFormat colmap_text{.name = "COLMAP text",
                                               .listed = "COLMAP points3D",
                                               .by_content = is_colmap_text,
                                               .read = without_options<read_colmap_text>};

}  // namespace formats

}  // namespace cmap
