#include <algorithm>

#include "io/array_store.hpp"
#include "io/cloud_builder.hpp"
#include "io/format_readers.hpp"
#include "io/session_arrays.hpp"

namespace cmap {
namespace {

using Shape = std::vector<std::uint64_t>;

bool is_point_array(const NpyArray& array) {
  const Shape& shape = array.shape();
  const bool floating = array.header.type == NpyType::kFloat16 || array.header.type == NpyType::kFloat32 ||
                        array.header.type == NpyType::kFloat64;
  return floating && shape.size() >= 2 && shape.back() == 3;
}

/// The points of a (..., 3) array of floats, with a color each or none at all.
PointCloud cloud_of(const ByteSource& source, const NpyArray& points, const Array<Rgb8>& colors, FileInfo& info) {
  if (!is_point_array(points)) {
    points.fail("values of type {} and shape {}; floats of shape (N, 3) expected of points",
                npy_type_name(points.header.type), shape_text(points.shape()));
  }
  const bool wide = points.header.type == NpyType::kFloat64;
  const Array<float> narrow = wide ? Array<float>() : points.to_floats();
  const auto* data = wide ? points.bytes.data() : reinterpret_cast<const std::byte*>(narrow.data());
  const ScalarType type = wide ? ScalarType::kFloat64 : ScalarType::kFloat32;
  PointColumns columns;
  for (std::size_t k = 0; k < 3; ++k) {
    columns.position[k] = {data + k * scalar_bytes(type), 3 * scalar_bytes(type), type};
    if (colors.empty()) continue;
    columns.rgb[k] = {reinterpret_cast<const std::byte*>(colors.data()) + k, sizeof(Rgb8), ScalarType::kUint8};
  }
  columns.color = colors.empty() ? ColorStorage::kNone : ColorStorage::kSeparate;
  const std::uint64_t n = points.size() / 3;
  CloudBuilder builder(source, {wide, {columns.color, ScalarType::kUint8}}, n);
  builder.append(columns, n);
  return builder.finish(info);
}

/// VGGT-SLAM's keyframe: the points that its mask keeps.
PointCloud point_map_of(const ByteSource& source, const ArrayStore& store, FileInfo& info) {
  info.format = "NPZ VGGT-SLAM point map";
  NpyArray points = store.read("pointcloud");
  if (!store.has("mask")) return cloud_of(source, points, {}, info);
  const NpyArray mask = store.read("mask");
  Shape shape = points.shape();
  if (!is_point_array(points)) points.fail("floats of shape (H, W, 3) or (N, 3) expected");
  shape.pop_back();
  require_shape(mask, shape);
  const Array<std::uint8_t> keep = mask.to_bytes();
  const std::size_t record = 3 * npy_type_bytes(points.header.type);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    if (keep[i] == 0) continue;
    std::copy_n(points.bytes.begin() + static_cast<std::ptrdiff_t>(i * record), record,
                points.bytes.begin() + static_cast<std::ptrdiff_t>(kept * record));
    ++kept;
  }
  if (kept < keep.size())
    info.notes.push_back(fmt::format("{} of {} points left out by the mask", keep.size() - kept, keep.size()));
  points.header.shape = {kept, 3};
  points.header.values = 3 * kept;
  return cloud_of(source, points, {}, info);
}

/// VGGT's predictions: every point of the point head, with the color of its pixel.
PointCloud predictions_of(const ByteSource& source, const ArrayStore& store, FileInfo& info) {
  info.format = "NPZ VGGT predictions";
  const NpyArray points = store.read("world_points");
  require_shape(points, {0, 0, 0, 3});
  Array<Rgb8> colors;
  if (store.has("images"))
    colors = to_colors(store.read("images"), points.shape()[0], points.shape()[1], points.shape()[2]);
  info.notes.emplace_back("all of world_points taken, whatever their confidence, in the unit of the session");
  return cloud_of(source, points, colors, info);
}

}  // namespace

PointCloud read_npy_cloud(ByteSource& source, FileInfo& info) {
  const NpyArray points = read_npy(source);
  info.format = fmt::format("NPY {}", npy_type_name(points.header.type));
  return cloud_of(source, points, {}, info);
}

PointCloud read_npz_cloud(ByteSource& source, FileInfo& info) {
  Array<std::byte> bytes(source.size());
  source.read(bytes, "the file");
  const ArrayStore store(source.name(), bytes);
  if (store.has("pointcloud")) return point_map_of(source, store, info);
  if (store.has("world_points")) return predictions_of(source, store, info);
  if (store.has("depth")) {
    source.fail("holds depth but no world_points: a session for cmap_recon, not a point cloud");
  }
  info.format = "NPZ";
  if (store.has("points")) return cloud_of(source, store.read("points"), {}, info);
  std::vector<std::string> names;
  for (const ZipMember& member : store.archive()->members()) names.push_back(member.name);
  if (names.size() == 1 && names[0].ends_with(".npy")) {
    return cloud_of(source, store.read(names[0].substr(0, names[0].size() - 4)), {}, info);
  }
  constexpr std::size_t kMostNames = 10;
  if (names.size() > kMostNames) names.resize(kMostNames);
  source.fail("a ZIP file without points.npy, world_points.npy or pointcloud.npy; it holds {}", fmt::join(names, ", "));
}

}  // namespace cmap
