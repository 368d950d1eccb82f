#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "clouds/cloud_format.hpp"
#include "clouds/record_reader.hpp"

namespace cmap {
namespace {

/// Points of so many float32 each; the first three are x y z, the fourth an intensity.
struct RawLayout {
  std::string_view name;
  std::string_view values;
  std::size_t n_floats;
};
constexpr RawLayout kKitti{"KITTI .bin", "x y z intensity", 4};
constexpr RawLayout kNuScenes{"nuScenes .pcd.bin", "x y z intensity ring", 5};
constexpr RawLayout kBare{"raw float32", "x y z", 3};

constexpr float kFarthest_m = 1e6F;
constexpr float kHighestIntensity = 65535.0F;
/// A column of intensities is told from coordinates by what so many coordinates break. Were the layout another one,
/// each of them would fall into that column with a chance of one in four or five.
constexpr std::size_t kEnough = 12;

/// The floats at the start of a file.
std::vector<float> sample(ByteSource& source) {
  const auto window = source.peek(std::min<std::uint64_t>(source.size(), FileStart::kBytes));
  std::vector<float> values(std::min(window.size(), FileStart::kBytes) / sizeof(float));
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::array<std::byte, sizeof(float)> raw;
    std::memcpy(raw.data(), window.data() + i * sizeof(float), sizeof(float));
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    values[i] = std::bit_cast<float>(raw);
  }
  return values;
}

bool is_coordinate(float value) {
  return std::isnan(value) || value == 0.0F || (std::isnormal(value) && std::abs(value) <= kFarthest_m);
}

/// Whether the floats, n to a point, may be coordinates and what follows them.
bool fits(const std::vector<float>& values, const RawLayout& layout) {
  for (std::size_t i = 0; i < values.size() / layout.n_floats * layout.n_floats; ++i) {
    const std::size_t column = i % layout.n_floats;
    const float value = values[i];
    if (column < 3 && !is_coordinate(value)) return false;
    if (column == 3 && !(value == 0.0F || (std::isnormal(value) && value > 0.0F && value <= kHighestIntensity))) {
      return false;
    }
    if (column == 4 && !(value >= 0.0F && value <= 255.0F && value == std::trunc(value))) return false;
  }
  return true;
}

/// Whether the last column keeps a rule that the coordinates break often.
bool stands_out(const std::vector<float>& values, const RawLayout& layout) {
  const auto kept_by_last_only = [&](auto&& keeps) {
    std::size_t n_broken = 0;
    for (std::size_t i = 0; i < values.size() / layout.n_floats * layout.n_floats; ++i) {
      if (keeps(values[i])) continue;
      if (i % layout.n_floats == layout.n_floats - 1) return false;
      ++n_broken;
    }
    return n_broken >= kEnough;
  };
  return kept_by_last_only([](float v) { return v >= 0.0F; }) ||
         kept_by_last_only([](float v) { return v >= 0.0F && v <= 1.0F; }) ||
         kept_by_last_only([](float v) { return v == std::trunc(v); });
}

bool divides(const ByteSource& source, const RawLayout& layout) {
  return source.size() % (layout.n_floats * sizeof(float)) == 0;
}

const RawLayout& find_layout(ByteSource& source) {
  if (!divides(source, kKitti) && !divides(source, kNuScenes)) {
    source.fail("{} bytes are no whole number of points of 16 ({}) or 20 bytes ({}): cut, or of another format",
                source.size(), kKitti.values, kNuScenes.values);
  }
  const std::vector<float> values = sample(source);
  const auto may_be = [&](const RawLayout& layout) { return divides(source, layout) && fits(values, layout); };
  const bool kitti = may_be(kKitti);
  const bool nuscenes = may_be(kNuScenes);
  if (kitti && nuscenes) {
    source.fail("raw numbers that may be {} ({}) as well as {} ({}); write them in a format that names its columns",
                kKitti.name, kKitti.values, kNuScenes.name, kNuScenes.values);
  }
  if (!kitti && !nuscenes) {
    source.fail("is neither {} ({} as float32) nor {} ({}), as its values show", kKitti.name, kKitti.values,
                kNuScenes.name, kNuScenes.values);
  }
  const RawLayout& layout = kitti ? kKitti : kNuScenes;
  if (may_be(kBare) && !stands_out(values, layout)) {
    source.fail("raw numbers that may be {} ({}) as well as {}; write them in a format that names its columns",
                layout.name, layout.values, kBare.values);
  }
  return layout;
}

RecordLayout record_layout(const RawLayout& raw) {
  RecordLayout layout;
  layout.bytes = raw.n_floats * sizeof(float);
  layout.columns.swap_bytes = std::endian::native == std::endian::big;
  for (std::size_t k = 0; k < 3; ++k) {
    layout.position_offsets[k] = k * sizeof(float);
    layout.columns.position[k].type = ScalarType::kFloat32;
  }
  return layout;
}

PointCloud read_kitti_bin(ByteSource& source, FileInfo& info) {
  const RawLayout& raw = find_layout(source);
  info.format = raw.name;
  info.notes.push_back(fmt::format("taken as float32 {} (a raw file does not say)", raw.values));
  const RecordLayout layout = record_layout(raw);
  const std::uint64_t n = source.size() / layout.bytes;
  CloudBuilder builder(source, {}, n);
  read_records(source, n, layout, builder);
  return builder.finish(info);
}

}  // namespace

namespace formats {

extern constinit const CloudFormat kitti_bin{
    .name = "KITTI .bin",
    .listed = "KITTI .bin",
    .by_name = [](const FileStart& start) { return start.extension == ".bin"; },
    .read = without_options<read_kitti_bin>};

}  // namespace formats

}  // namespace cmap
