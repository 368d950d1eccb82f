#pragma once

#include <optional>
#include <string>

#include "containers/npy_array.hpp"

namespace cmap {

/// An array of plain numbers as a table of points: a row each, x y z first.
struct PointTable {
  std::uint64_t rows = 0;
  std::size_t columns = 0;
  bool transposed = false;  ///< stored as `columns` rows of `rows` numbers

  /// Where column j lies in the array's bytes.
  std::size_t column_offset(std::size_t j, std::size_t value_bytes) const {
    return j * value_bytes * (transposed ? rows : 1);
  }
  std::size_t stride(std::size_t value_bytes) const { return value_bytes * (transposed ? 1 : columns); }
};

/// An array of so many dimensions has one of scenes in front: (scene, view, row, column, x y z).
inline constexpr std::size_t kBatchDimensions = 5;

/// How an array of this shape is a table: (..., C) or (C, N) with C from 3 to 9; nothing where it is none.
std::optional<PointTable> find_point_table(const std::vector<std::uint64_t>& shape);

/// The table of an array of numbers. Throws InputError for anything else, naming what it is where that can be told:
/// transforms and poses, camera matrices, pictures, truth values, a batch of several scenes, shapes with two readings.
PointTable require_point_table(const NpyArray& array);

}  // namespace cmap
