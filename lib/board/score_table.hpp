#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cmap {

/// Best and second best among the values that are compared with each other; values that look the same share their
/// mark. Better and worse are differences, whose sign says the same.
enum class Mark { kNone, kBest, kSecond, kBetter, kWorse };

/// Where a table has no number.
inline constexpr std::string_view kNoValue = "-", kFailedMark = "x";

struct TableCell {
  std::string text;
  std::optional<double> value;  ///< what the text shows, for sorting
  Mark mark = Mark::kNone;
  std::string note;  ///< for people who ask: why there is no value, all digits
};

struct TableRow {
  std::vector<std::string> heads;
  std::vector<TableCell> cells;
};

/// A table as people read it; the typesetters know nothing about metrics.
struct ScoreTable {
  std::string id;     ///< unique in its document
  std::string title;  ///< may be empty
  std::vector<std::string> head_columns, value_columns;
  std::vector<TableRow> rows;
  std::vector<std::string> notes;  ///< below the table
};

/// Marks the cells that have a value. `better` is "lower" or "higher", all else marks nothing, as does a lone value.
void mark_best(const std::vector<TableCell*>& cells, std::string_view better);

/// Marks within each column of the table.
void mark_columns(ScoreTable& table, std::string_view better);

/// Text of one line for any terminal or page: control characters become blanks, bytes that are no UTF-8 become U+FFFD.
std::string one_line(std::string_view text);

enum class TableFormat { kText, kMarkdown, kLatex };

/// The tables one after the other. Notes that tables share stand once, at the end.
std::string typeset(const std::vector<ScoreTable>& tables, TableFormat format);

std::string escaped_markdown(std::string_view text);
std::string escaped_latex(std::string_view text);
std::string escaped_html(std::string_view text);

/// A field of a CSV file: quoted where it must be.
std::string csv_field(std::string_view text);

/// A number's digits, never exactly three after the point: where a point separates thousands, spreadsheets read 0.835
/// as 835.
std::string csv_digits(std::string number);

/// An empty field for a missing value; all digits otherwise. Infinity is "inf".
std::string csv_number(const std::optional<double>& value);

}  // namespace cmap
