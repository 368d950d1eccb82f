#include "clouds/text/text_layout.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "clouds/column_names.hpp"
#include "clouds/foreign_formats.hpp"
#include "clouds/not_a_cloud.hpp"
#include "clouds/point_schema.hpp"
#include "cmap/core/spelling.hpp"

namespace cmap {
namespace {

using Names = std::vector<std::string>;

/// Whether the first column numbers the rows or labels them, as R's write.table() puts it there without a name.
bool names_rows(const NumberTable& table) {
  if (table.rows() < 2) return false;
  const double first = table.at(0, 0);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double value = table.at(row, 0);
    if (!std::isnan(value) && value != first + static_cast<double>(row)) return false;
  }
  return true;
}

Names header_names(const TextStart& start, const NumberTable& table) {
  Names names = column_names(start.header->text, start.format, table.columns);
  if (names.size() + 1 == table.columns && names_rows(table)) names.insert(names.begin(), "");
  return names;
}

/// The last comment that names as many columns as there are, coordinates among them.
std::optional<Names> commented_names(const TextStart& start, std::size_t n_columns) {
  for (auto comment = start.comments.rbegin(); comment != start.comments.rend(); ++comment) {
    Names names = column_names(comment->text, start.format, n_columns);
    if (names.size() == n_columns && find_point_names(names).position) return names;
  }
  return std::nullopt;
}

/// Refuses names and numbers that are something else than points.
void refuse_other_content(const ByteSource& source, const TextStart& start, const NumberTable& table) {
  constexpr std::size_t kJudged = 64;
  if (start.header) {
    const Names names = header_names(start, table);
    if (names_splats(names)) source.fail("line {}: {}", start.header->number, splat_hint());
    if (names_poses(names)) source.fail("line {}: {}", start.header->number, pose_hint());
    return;
  }
  if (start.count) return;
  std::vector<std::vector<double>> rows;
  std::vector<std::string_view> columns;
  for (const TextLine& line : start.rows) {
    if (rows.size() == kJudged) break;
    split_row(line.text, start.format.separator, columns);
    std::vector<double>& row = rows.emplace_back(columns.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (!parse_column(columns[i], start.format, row[i])) return;
    }
  }
  const bool complete = start.whole && rows.size() == start.rows.size();
  if (const auto what = not_a_cloud(rows, complete)) source.fail("{}", *what);
}

[[noreturn]] void fail_without_position(const ByteSource& source, const TextLine& header, const Names& names) {
  if (names_degrees(names)) {
    source.fail("line {}: the points are given as longitude and latitude; project them to meters first", header.number);
  }
  source.fail("line {}: the header names no coordinates (x y z, easting northing height): {}", header.number,
              listed(names));
}

void assign_by_names(const Names& names, TextLayout& layout, FileInfo& info) {
  const PointNames found = find_point_names(names);
  layout.position = *found.position;
  layout.color = found.color;
  if (!found.color && found.n_color_channels > 0) {
    info.notes.push_back(
        fmt::format("no color taken: only {} of the three columns red, green, blue present", found.n_color_channels));
  }
  note_units(names, layout.position, info);
  Names unused;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto is_i = [i](std::size_t column) { return column == i; };
    const bool used =
        std::ranges::any_of(layout.position, is_i) || (layout.color && std::ranges::any_of(*layout.color, is_i));
    if (!used) unused.push_back(names[i]);
  }
  note_unused(unused, "columns", info);
}

bool is_pts(const ByteSource& source) {
  return lower_case(std::filesystem::path(source.name()).extension().string()) == ".pts";
}

void assign_by_numbers(const ByteSource& source, const NumberTable& table, TextLayout& layout, FileInfo& info) {
  const RowNumbers numbers = find_row_numbers(table);
  if (numbers == RowNumbers::kNone) {
    layout.color = find_unnamed_colors(table, is_pts(source), info);
    return;
  }
  if (numbers == RowNumbers::kUndecidable) {
    source.fail(
        "column 1 counts from {:g} on: numbers of the rows, or an x; a first line such as 'id x y z r g b' or "
        "'x y z i r g b', with as many names as there are columns, says which",
        table.at(0, 0));
  }
  info.notes.emplace_back("column 1 numbers the rows; columns 2 to 4 taken as x, y and z");
  layout.position = {1, 2, 3};
  layout.color = find_unnamed_colors(without_first_column(table), is_pts(source), info);
  if (layout.color) {
    for (std::size_t& column : *layout.color) ++column;
  }
}

}  // namespace

TextLayout text_layout(const ByteSource& source, const TextStart& start, FileInfo& info) {
  const NumberTable table = number_table(start);
  const std::uint64_t first_row = start.rows.front().number;
  refuse_other_content(source, start, table);
  TextLayout layout;
  layout.columns = table.columns;
  if (start.header) {
    const Names names = header_names(start, table);
    if (!find_point_names(names).position) fail_without_position(source, *start.header, names);
    if (names.size() != table.columns) {
      source.fail("line {}: {} columns, but the header line names {}", first_row, table.columns, names.size());
    }
    assign_by_names(names, layout, info);
    return layout;
  }
  if (table.columns < 3) source.fail("line {}: {} columns; at least x y z expected", first_row, table.columns);
  if (const auto names = commented_names(start, table.columns)) {
    assign_by_names(*names, layout, info);
    return layout;
  }
  assign_by_numbers(source, table, layout, info);
  return layout;
}

}  // namespace cmap
