#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <set>

#include "io/ascii_rows.hpp"
#include "io/format_readers.hpp"
#include "io/number_text.hpp"

namespace cmap {
namespace {

constexpr std::size_t kRowValues = 8;       // POINT3D_ID X Y Z R G B ERROR; then the track
constexpr std::size_t kTrackPairBytes = 8;  // IMAGE_ID, POINT2D_IDX

/// Of a binary point, before its track: id, x y z as doubles, r g b as bytes, error, length of the track.
constexpr std::size_t kXyzOffset = 8;
constexpr std::size_t kRgbOffset = 32;
constexpr std::size_t kErrorOffset = 35;
constexpr std::size_t kTrackOffset = 43;
constexpr std::size_t kPointBytes = 51;
constexpr std::size_t kStagedPoints = 1024;

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

template <class T>
T load(std::span<const std::byte> bytes, std::size_t offset) {
  std::array<std::byte, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes.data() + offset, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// Neither a denormal number nor one that no coordinate reaches: what other bytes mostly give.
bool is_plausible(double value) { return value == 0.0 || (std::isnormal(value) && std::abs(value) <= 1e9); }

PointColumns columns_of_points(const std::byte* data) {
  PointColumns columns;
  columns.swap_bytes = std::endian::native == std::endian::big;
  columns.color = ColorStorage::kSeparate;
  for (std::size_t k = 0; k < 3; ++k) {
    columns.position[k] = {data + kXyzOffset + 8 * k, kPointBytes, ScalarType::kFloat64};
    columns.rgb[k] = {data + kRgbOffset + k, kPointBytes, ScalarType::kUint8};
  }
  return columns;
}

}  // namespace

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
  CloudBuilder builder(source, {true, {ColorStorage::kSeparate, ScalarType::kUint8}}, source.size() / (2 * kRowValues) + 1);
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

bool is_colmap_binary(const FileStart& start) {
  if (start.name == "points3d.bin") return true;
  if (start.text || start.bytes.size() < 8 + kPointBytes) return false;
  const auto bytes = std::as_bytes(std::span(start.bytes));
  const auto n = load<std::uint64_t>(bytes, 0);
  if (n == 0 || n > (start.size - 8) / kPointBytes) return false;
  // The points that lie in the start, one after the other; random bytes do not reach the second.
  std::size_t place = 8;
  for (std::uint64_t i = 0; i < n && place + kPointBytes <= bytes.size(); ++i) {
    const auto point = bytes.subspan(place);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!is_plausible(load<double>(point, kXyzOffset + 8 * k))) return false;
    }
    const auto track = load<std::uint64_t>(point, kTrackOffset);
    if (!is_plausible(load<double>(point, kErrorOffset))) return false;
    if (track > (start.size - place - kPointBytes) / kTrackPairBytes) return false;
    place += kPointBytes + track * kTrackPairBytes;
  }
  return true;
}

PointCloud read_colmap_binary(ByteSource& source, FileInfo& info) {
  info.format = "COLMAP points3D binary";
  std::array<std::byte, 8> count{};
  source.read(count, "the number of points");
  const auto n = load<std::uint64_t>(count, 0);
  if (n > source.remaining() / kPointBytes) {
    source.fail("truncated: {} points of at least {} bytes do not fit into {} bytes", n, kPointBytes, source.size());
  }
  CloudBuilder builder(source, {true, {ColorStorage::kSeparate, ScalarType::kUint8}}, n);
  std::vector<std::byte> points;  // some at a time, without their tracks
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::size_t place = points.size();
    points.resize(place + kPointBytes);
    source.read(std::span(points).subspan(place), "a point");
    const auto track = load<std::uint64_t>(std::span(points).subspan(place), kTrackOffset);
    if (track > source.remaining() / kTrackPairBytes) {
      source.fail("truncated: point {} of {} has a track of {} entries, but {} bytes follow", i + 1, n, track,
                  source.remaining());
    }
    source.skip(track * kTrackPairBytes, "a track");
    if (points.size() < kStagedPoints * kPointBytes && i + 1 < n) continue;
    builder.append(columns_of_points(points.data()), points.size() / kPointBytes);
    points.clear();
  }
  if (source.remaining() > 0) source.fail("{} bytes left over after its {} points", source.remaining(), n);
  return builder.finish(info);
}

}  // namespace cmap
