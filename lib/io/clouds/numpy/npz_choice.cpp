#include "clouds/numpy/npz_choice.hpp"

#include <algorithm>
#include <array>

#include "clouds/numpy/npz_colors.hpp"
#include "clouds/point_names.hpp"
#include "containers/npy_shape.hpp"

namespace cmap {
namespace {

using NpzEntries = std::vector<NpzEntry>;

constexpr std::string_view kPointNames[] = {
    "pointcloud", "worldpoints", "points", "xyz",          "positions", "worldpointsfromdepth",
    "position",   "pos",         "coords", "coordinates",  "vertices",  "verts",
    "points3d",   "pts3d",       "pts",    "point",        "pointsxyz", "cloud",
    "pcd",        "pc",          "coord",  "globalpoints", "location",  "locations",
    "lidar",      "scan",        "data",   "arr0"};
constexpr std::string_view kColorNames[] = {
    "colors",       "color",     "colours",  "colour",    "rgb",       "rgbs",        "rgba",         "pointcolors",
    "pointscolors", "pointsrgb", "pointrgb", "colorsrgb", "pcdcolors", "cloudcolors", "vertexcolors", "vertexcolor"};
constexpr std::string_view kPictureNames[] = {"images", "image", "imgs", "img", "inputimgs"};
constexpr std::string_view kMaskNames[] = {"mask", "valid", "validmask", "masks"};
// Arrays of three numbers a row that are no points.
constexpr std::string_view kOtherNames[] = {
    "normals", "normal", "faces",     "triangles",  "cells", "tris",      "mesh",       "rays",
    "flow",    "bbox",   "extrinsic", "extrinsics", "poses", "intrinsic", "intrinsics", "camerapositions",
    "arr1",    "depth",  "depths",    "depthconf",  "conf"};

template <std::size_t n>
bool is_one_of(std::string_view name, const std::string_view (&names)[n]) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

const NpzEntry* find(const NpzEntries& entries, std::string_view plain) {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return plain_name(e.name) == plain; });
  return found == entries.end() ? nullptr : &*found;
}

bool is_number(const NpzEntry& entry) {
  return entry.header && !entry.header->is_record() &&
         (entry.header->fields[0].kind == NpyKind::kNumber || entry.header->fields[0].kind == NpyKind::kHalf);
}

bool has_point_shape(const NpzEntry& entry) {
  if (!entry.header) return false;
  if (entry.header->is_record()) return true;
  const auto& shape = entry.header->shape;
  const bool matrices = shape.size() > 2 && shape.back() == 4 && (shape.end()[-2] == 3 || shape.end()[-2] == 4);
  return is_number(entry) && entry.header->fields[0].scalar != ScalarType::kUint8 && !matrices &&
         find_point_table(shape).has_value();
}

bool is_column(const NpzEntry* entry) {
  if (entry == nullptr || !is_number(*entry)) return false;
  const auto& shape = entry->header->shape;
  return shape.size() == 1 || (shape.size() == 2 && shape[1] == 1);
}

std::vector<std::string> coordinate_arrays(const NpzEntries& entries) {
  std::vector<std::string> names;
  for (const std::string_view axis : {"x", "y", "z"}) {
    const NpzEntry* entry = find(entries, axis);
    if (!is_column(entry)) return {};
    names.push_back(entry->name);
  }
  return names;
}

/// Without a usual name: floats that are no small matrix, or records.
bool may_be_points(const NpzEntry& entry) {
  const std::string plain = plain_name(entry.name);
  if (is_one_of(plain, kColorNames) || is_one_of(plain, kPictureNames) || is_one_of(plain, kOtherNames)) return false;
  if (!has_point_shape(entry)) return false;
  const auto& shape = entry.header->shape;
  const bool matrix = shape.size() == 2 && shape[0] <= 4 && shape[1] <= 4;
  return entry.header->is_record() || (is_floating(entry.header->fields[0].scalar) && !matrix);
}

std::vector<std::string> arrays_with_point_shape(const NpzEntries& entries) {
  std::vector<std::string> names;
  for (const NpzEntry& entry : entries) {
    if (may_be_points(entry)) names.push_back(entry.name);
  }
  return names;
}

/// "a (10, 3) <f4, b.txt and 3 more"
std::string listed_entries(const NpzEntries& entries) {
  constexpr std::size_t kMost = 10;
  std::vector<std::string> texts;
  for (const NpzEntry& entry : entries) {
    if (texts.size() == kMost) break;
    texts.push_back(entry.header ? fmt::format("{} {} {}", entry.name, shape_text(entry.header->shape),
                                               entry.header->is_record() ? "records" : entry.header->type_text())
                                 : entry.name);
  }
  const std::string more = entries.size() > kMost ? fmt::format(" and {} more", entries.size() - kMost) : "";
  return fmt::format("{}{}", fmt::join(texts, ", "), more);
}

[[noreturn]] void refuse(const ByteSource& source, const NpzEntries& entries,
                         const std::vector<std::string>& candidates) {
  if (find(entries, "depth") != nullptr) {
    source.fail("holds depth but no world_points: a session for cmap_recon, not a point cloud");
  }
  if (entries.empty()) source.fail("an empty ZIP file");
  if (candidates.empty()) {
    source.fail(
        "a ZIP file without an array of points (points, xyz, positions, pointcloud or world_points of shape "
        "(N, 3)); it holds {}",
        listed_entries(entries));
  }
  source.fail("several arrays may be the points; name the right one 'points': it holds {}", listed_entries(entries));
}

/// The reason why numbers beside the points are no colors.
[[noreturn]] void refuse_count(const ByteSource& source, const NpzEntry& entry, const std::string& points_name,
                               const NpyPoints& points, std::string_view what) {
  source.fail("{} has the shape {}, but {} holds {} points (shape {}); {} a point expected", entry.name,
              shape_text(entry.header->shape), points_name, points.n, shape_text(points.shape), what);
}

bool is_packed(const NpzEntry& entry, std::string_view plain, const NpyPoints& points) {
  const NpyField& field = entry.header->fields[0];
  return (plain == "rgb" || plain == "rgba") && field.value_bytes == sizeof(std::uint32_t) &&
         match_points(entry.header->shape, 1, points.shape).has_value();
}

/// Red, green and blue in arrays of their own.
std::optional<ColorArrays> channel_arrays(const NpzEntries& entries, std::uint64_t n) {
  constexpr std::array<std::array<std::string_view, 3>, 2> kChannels{{{"red", "green", "blue"}, {"r", "g", "b"}}};
  for (const auto& channels : kChannels) {
    ColorArrays found;
    for (const std::string_view channel : channels) {
      const NpzEntry* entry = find(entries, channel);
      if (is_column(entry) && entry->header->items == n) found.names.push_back(entry->name);
    }
    if (found.names.size() == channels.size()) return found;
  }
  return std::nullopt;
}

/// numpy.savez(file, points, colors) without names; floats might as well be normals.
std::optional<ColorArrays> colors_without_name(const NpzEntries& entries, const std::string& points_name,
                                               const NpyPoints& points, FileInfo& info) {
  const NpzEntry* entry = find(entries, "arr1");
  if (points_name != "arr_0" || entry == nullptr || !is_number(*entry)) return std::nullopt;
  if (entry->header->fields[0].scalar != ScalarType::kUint8) return std::nullopt;
  if (!match_colors(entry->header->shape, points.shape)) return std::nullopt;
  info.notes.push_back(fmt::format("{} taken as the colors of {}", entry->name, points_name));
  return ColorArrays{{entry->name}, false};
}

/// Whether an array with the name of colors has so many rows that it cannot belong to the points.
bool has_other_count(const NpzEntry& entry, const NpyPoints& points) {
  const auto& shape = entry.header->shape;
  if (shape.empty()) return false;
  for (const std::uint64_t channels :
       {shape.back(), shape[shape.size() < 3 ? 0 : shape.size() - 3], std::uint64_t{1}}) {
    if (match_points(shape, channels, points.shape)) return false;
  }
  return true;
}

}  // namespace

PointArrays choose_point_arrays(const ByteSource& source, const NpzEntries& entries) {
  const NpzEntry* named = nullptr;
  for (const std::string_view name : kPointNames) {
    const NpzEntry* entry = find(entries, name);
    if (entry == nullptr) continue;
    if (has_point_shape(*entry)) return {{entry->name}, false};
    if (named == nullptr) named = entry;
  }
  if (std::vector<std::string> axes = coordinate_arrays(entries); !axes.empty()) return {std::move(axes), false};
  if (named != nullptr) return {{named->name}, false};  // whoever reads it says what is wrong with it
  std::vector<std::string> candidates = arrays_with_point_shape(entries);
  if (candidates.size() == 1) return {std::move(candidates), true};
  const bool only_one = entries.size() == 1 && entries[0].header && find(entries, "depth") == nullptr;
  if (only_one) return {{entries[0].name}, true};
  refuse(source, entries, candidates);
}

std::optional<ColorArrays> choose_colors(const ByteSource& source, const NpzEntries& entries,
                                         const std::string& points_name, const NpyPoints& points, FileInfo& info) {
  const NpzEntry* wrong = nullptr;
  const auto look = [&](std::string_view name) -> std::optional<ColorArrays> {
    const NpzEntry* entry = find(entries, name);
    if (entry == nullptr || entry->name == points_name || !is_number(*entry)) return std::nullopt;
    if (match_colors(entry->header->shape, points.shape)) return ColorArrays{{entry->name}, false};
    if (is_packed(*entry, name, points)) return ColorArrays{{entry->name}, true};
    if (!has_other_count(*entry, points)) {
      info.notes.push_back(fmt::format("no color taken from {}: its shape is {}, not three numbers a point",
                                       entry->name, shape_text(entry->header->shape)));
    } else if (wrong == nullptr && (is_one_of(name, kColorNames) || points.shape.size() > 1)) {
      wrong = entry;
    }
    return std::nullopt;
  };
  for (const std::string_view name : kColorNames) {
    if (auto found = look(name)) return found;
  }
  if (auto found = channel_arrays(entries, points.n)) return found;
  for (const std::string_view name : kPictureNames) {
    if (auto found = look(name)) return found;
  }
  if (wrong != nullptr) refuse_count(source, *wrong, points_name, points, "a color");
  return colors_without_name(entries, points_name, points, info);
}

std::optional<std::string> choose_mask(const ByteSource& source, const NpzEntries& entries,
                                       const std::string& points_name, const NpyPoints& points) {
  for (const std::string_view name : kMaskNames) {
    const NpzEntry* entry = find(entries, name);
    if (entry == nullptr || !entry->header || entry->header->is_record()) continue;
    const NpyField& field = entry->header->fields[0];
    if (field.kind != NpyKind::kBool && (field.kind != NpyKind::kNumber || is_floating(field.scalar))) continue;
    if (!match_points(entry->header->shape, 1, points.shape)) {
      refuse_count(source, *entry, points_name, points, "one value");
    }
    return entry->name;
  }
  return std::nullopt;
}

}  // namespace cmap
