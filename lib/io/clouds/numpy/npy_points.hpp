#pragma once

#include <span>

#include "clouds/cloud_builder.hpp"
#include "containers/npy_array.hpp"

namespace cmap {

/// Points in memory, as columns of the arrays that hold them, which must outlive this.
struct NpyPoints {
  std::uint64_t n = 0;
  std::vector<std::uint64_t> shape;  ///< of the points: that of the array without the numbers of a point
  CloudLayout layout;
  PointColumns columns;
  /// Colors in planes, one after the other for each frame: points of a frame, and bytes from one frame's to the next's.
  std::uint64_t frame_points = 0;  ///< 0: one frame
  std::size_t frame_color_bytes = 0;

  bool has_color() const { return columns.color != ColorStorage::kNone; }
};

/// A named column, one number (or `count`) a point, wherever it lies.
struct NamedColumn {
  std::string name;
  NpyField field;
  Column column;
};

/// The points of one array, plain or of records, with the colors that it holds. Says in `info` what was decided and
/// what is not used. Throws InputError where it holds no points (see require_point_table), and for raw integers of LAS,
/// which mean nothing without their scale.
NpyPoints points_of(const NpyArray& array, FileInfo& info);

/// Points whose coordinates are columns of their own; `name` stands for the file and array in messages.
NpyPoints points_of_columns(const std::string& name, std::span<const NamedColumn> columns, std::uint64_t n,
                            FileInfo& info);

/// Three columns as the colors of the points.
void set_colors(NpyPoints& points, const std::array<Column, 3>& rgb);

/// Appends the points from `first` up to `last`.
void append_points(const NpyPoints& points, std::uint64_t first, std::uint64_t last, CloudBuilder& builder);

}  // namespace cmap
