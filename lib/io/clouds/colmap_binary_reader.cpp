#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "bytes/little_endian.hpp"
#include "clouds/cloud_builder.hpp"
#include "clouds/cloud_format.hpp"

namespace cmap {
namespace {

constexpr std::size_t kTrackPairBytes = 8;  // IMAGE_ID, POINT2D_IDX

/// Of a binary point, before its track: id, x y z as doubles, r g b as bytes, error, length of the track.
constexpr std::size_t kXyzOffset = 8;
constexpr std::size_t kRgbAt = 32;
constexpr std::size_t kErrorOffset = 35;
constexpr std::size_t kTrackOffset = 43;
constexpr std::size_t kPointBytes = 51;
constexpr std::size_t kStagedPoints = 1024;

/// Neither a denormal number nor one that no coordinate reaches: what other bytes mostly give.
bool is_plausible(double value) { return value == 0.0 || (std::isnormal(value) && std::abs(value) <= 1e9); }

PointColumns columns_of_points(const std::byte* data) {
  PointColumns columns;
  columns.swap_bytes = std::endian::native == std::endian::big;
  columns.color = ColorStorage::kSeparate;
  for (std::size_t k = 0; k < 3; ++k) {
    columns.position[k] = {data + kXyzOffset + 8 * k, kPointBytes, ScalarType::kFloat64};
    columns.rgb[k] = {data + kRgbAt + k, kPointBytes, ScalarType::kUint8};
  }
  return columns;
}

bool is_colmap_binary(const FileStart& start) {
  if (start.name == "points3d.bin") return true;
  if (start.text || start.bytes.size() < 8 + kPointBytes) return false;
  const auto bytes = std::as_bytes(std::span(start.bytes));
  const auto n = load_little<std::uint64_t>(bytes, 0);
  if (n == 0 || n > (start.size - 8) / kPointBytes) return false;
  // The points that lie in the start, one after the other; random bytes do not reach the second.
  std::size_t place = 8;
  for (std::uint64_t i = 0; i < n && place + kPointBytes <= bytes.size(); ++i) {
    const auto point = bytes.subspan(place);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!is_plausible(load_little<double>(point, kXyzOffset + 8 * k))) return false;
    }
    const auto track = load_little<std::uint64_t>(point, kTrackOffset);
    if (!is_plausible(load_little<double>(point, kErrorOffset))) return false;
    if (track > (start.size - place - kPointBytes) / kTrackPairBytes) return false;
    place += kPointBytes + track * kTrackPairBytes;
  }
  return true;
}

PointCloud read_colmap_binary(ByteSource& source, FileInfo& info) {
  info.format = "COLMAP points3D binary";
  std::array<std::byte, 8> count{};
  source.read(count, "the number of points");
  const auto n = load_little<std::uint64_t>(count, 0);
  if (n > source.remaining() / kPointBytes) {
    source.fail("truncated: {} points of at least {} bytes do not fit into {} bytes", n, kPointBytes, source.size());
  }
  CloudBuilder builder(source, {true, {ColorStorage::kSeparate, ScalarType::kUint8}}, n);
  std::vector<std::byte> points;  // some at a time, without their tracks
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::size_t place = points.size();
    points.resize(place + kPointBytes);
    source.read(std::span(points).subspan(place), "a point");
    const auto track = load_little<std::uint64_t>(std::span(points).subspan(place), kTrackOffset);
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

}  // namespace

namespace formats {

extern constinit const CloudFormat colmap_binary{
    .name = "COLMAP binary", .by_content = is_colmap_binary, .read = without_options<read_colmap_binary>};

}  // namespace formats

}  // namespace cmap
