#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cmap {

/// Best and second best among the values that are compared with each other; values that look the same share their
/// mark. The best that nobody tested is one by its value alone. Better and worse are differences, whose sign says the
/// same.
enum class Mark { kNone, kBest, kSecond, kBestUntested, kBetter, kWorse };

/// Where a table has no number.
inline constexpr std::string_view kNoValue = "-", kFailedMark = "x";

struct TableCell {
  std::string text;
  std::optional<double> value;  ///< what the text shows, for sorting
  Mark mark = Mark::kNone;
  std::string note;       ///< for people who ask: why there is no value, all digits
  std::string band = {};  ///< behind the value: "± 0.097"
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

/// Indices of the cells that have a value, the best first. None where `better` is neither "lower" nor "higher".
std::vector<std::size_t> ranked_cells(const std::vector<TableCell*>& cells, std::string_view better);

/// Marks the cells that have a value, by it alone. `better` is "lower" or "higher", all else marks nothing, as does a
/// lone value.
void mark_best(const std::vector<TableCell*>& cells, std::string_view better);

/// The cells of a row or column that are ranked against each other.
std::vector<TableCell*> cells_of(TableRow& row);
std::vector<TableCell*> cells_of(ScoreTable& table, std::size_t column);

/// Takes the bands from all cells.
void remove_bands(std::vector<ScoreTable>& tables);

/// Text of one line for any terminal or page: control characters become blanks, bytes that are no UTF-8 become U+FFFD.
std::string one_line(std::string_view text);

enum class TableFormat { kText, kMarkdown, kLatex };

/// What the marks of the format mean. Best and second best stand by value alone where `is_plain`.
std::string marks_note(TableFormat format, bool is_plain);
/// "- no value".
std::string missing_note(TableFormat format);

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
