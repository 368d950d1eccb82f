#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clouds/array_store.hpp"
#include "clouds/numpy/npy_points.hpp"

namespace cmap {

/// Which arrays of an NPZ file hold the coordinates, by their names (whatever the case) and shapes.
struct PointArrays {
  std::vector<std::string> names;  ///< one, or three: x, y and z
  bool by_shape = false;           ///< no name is a usual one: the only array that has the shape of points
};

/// The first array with a usual name (pointcloud, world_points, points, xyz, positions, ...) that has the shape of
/// points; else x, y and z; else the only one that has that shape. Throws InputError where there is none or are
/// several.
PointArrays choose_point_arrays(const ByteSource& source, const std::vector<NpzEntry>& entries);

/// What has a color for each point: one array, or red, green and blue in arrays of their own.
struct ColorArrays {
  std::vector<std::string> names;
  bool packed = false;  ///< 0x..RRGGBB
};

/// By name (colors, rgb, images, ...), the first that has as many as there are points. Notes those that cannot be
/// colors. Throws InputError, naming both arrays, where an array of colors has another number of them.
std::optional<ColorArrays> choose_colors(const ByteSource& source, const std::vector<NpzEntry>& entries,
                                         const std::string& points_name, const NpyPoints& points, FileInfo& info);

/// An array of truth values or whole numbers called mask or valid. Throws InputError where it has not one a point.
std::optional<std::string> choose_mask(const ByteSource& source, const std::vector<NpzEntry>& entries,
                                       const std::string& points_name, const NpyPoints& points);

}  // namespace cmap
