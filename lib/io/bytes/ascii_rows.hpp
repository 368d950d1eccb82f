#pragma once

#include <array>
#include <span>
#include <vector>

#include "clouds/cloud_builder.hpp"
#include "clouds/point_schema.hpp"
#include "cmap/io/line_reader.hpp"

namespace cmap {

/// Rows of numbers on their way into a builder, which takes columns.
class RowStage {
 public:
  struct Row {
    std::array<double, 3> xyz;
    std::array<double, 3> rgb;
  };
  RowStage(CloudBuilder& builder, bool has_color);
  void add(const Row& row) {
    rows_.push_back(row);
    if (rows_.size() == kRows) flush();
  }
  /// Hands over what is left; to be called at the end.
  void flush();

 private:
  static constexpr std::size_t kRows = 1024;
  CloudBuilder& builder_;
  PointColumns columns_;
  std::vector<Row> rows_;
};

/// Throws InputError unless n lines of these fields can lie in the rest of the file; call it before memory is taken.
void require_ascii_rows(const ByteSource& source, std::uint64_t n, std::span<const Field> fields);

/// Notes lines that follow the last row that the header counts.
void note_lines_left_over(LineReader& lines, FileInfo& info);

/// Reads n points, one a line (blank lines are passed over), values in the order of the fields.
void read_ascii_rows(LineReader& lines, std::uint64_t n, std::span<const Field> fields, const PointSchema& schema,
                     CloudBuilder& builder);

}  // namespace cmap
