#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "cmap/report/table_text.hpp"
#include "score_table.hpp"

namespace cmap {
namespace {

using Lines = std::vector<std::vector<std::string>>;

/// All rows as text, headings first, each cell as `shown` writes it.
Lines lines_of(const ScoreTable& table, const std::function<std::string(std::string_view)>& escaped,
               const std::function<std::string(const TableCell&)>& shown) {
  Lines lines(1);
  for (const auto* columns : {&table.head_columns, &table.value_columns}) {
    for (const std::string& column : *columns) lines.front().push_back(escaped(column));
  }
  for (const TableRow& row : table.rows) {
    std::vector<std::string>& line = lines.emplace_back();
    for (const std::string& head : row.heads) line.push_back(escaped(head));
    for (const TableCell& cell : row.cells) line.push_back(shown(cell));
  }
  return lines;
}

std::vector<std::size_t> widths_of(const Lines& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], character_count(line[i]));
  }
  return widths;
}

std::string right_aligned(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, character_count(text)), ' ') + text;
}

/// Heads at the left, values at the right of their columns.
std::string aligned(const Lines& lines, std::size_t n_heads) {
  const std::vector<std::size_t> widths = widths_of(lines);
  std::string text;
  for (const auto& cells : lines) {
    std::string line;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      line += (i == 0 ? "" : "  ") + (i < n_heads ? padded(cells[i], widths[i]) : right_aligned(cells[i], widths[i]));
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

/// Behind a value where there are neither fonts nor colors.
char sign_of(Mark mark) {
  switch (mark) {
    case Mark::kBest:
      return '*';
    case Mark::kSecond:
      return '+';
    case Mark::kBestUntested:
      return '?';
    default:
      return ' ';
  }
}

/// The cell's band behind its value, if it has one.
std::string with_band(const std::string& value, const TableCell& cell, const std::string& band) {
  return cell.band.empty() ? value : value + " " + band;
}

std::string text_table(const ScoreTable& table) {
  Lines lines = lines_of(table, one_line, [](const TableCell& cell) {
    const std::string value = cell.text + sign_of(cell.mark);
    return cell.band.empty() ? value : with_band(value, cell, cell.band) + " ";  // as wide as other marks
  });
  for (std::size_t i = table.head_columns.size(); i < lines.front().size(); ++i) lines.front()[i] += " ";
  return (table.title.empty() ? "" : one_line(table.title) + "\n") + aligned(lines, table.head_columns.size());
}

std::string markdown_table(const ScoreTable& table) {
  Lines lines = lines_of(table, escaped_markdown, [](const TableCell& cell) {
    const std::string text = escaped_markdown(cell.text);
    const std::string marked = cell.mark == Mark::kBest           ? "**" + text + "**"
                               : cell.mark == Mark::kSecond       ? "*" + text + "*"
                               : cell.mark == Mark::kBestUntested ? text + "?"
                                                                  : text;
    return with_band(marked, cell, escaped_markdown(cell.band));
  });
  std::vector<std::string> rule;
  for (std::size_t i = 0; i < lines.front().size(); ++i)
    rule.emplace_back(i < table.head_columns.size() ? "---" : "---:");
  lines.insert(lines.begin() + 1, rule);
  std::string text = table.title.empty() ? "" : fmt::format("### {}\n\n", escaped_markdown(table.title));
  for (const auto& line : lines) {
    text += "|";
    for (const std::string& cell : line) text += fmt::format(" {} |", cell);
    text += "\n";
  }
  return text;
}

/// Numbers have minus signs, not hyphens.
std::string latex_number(const std::string& text) {
  std::string number;
  for (char c : text) number += c == '-' ? "$-$" : std::string(1, c);
  return number;
}

std::string latex_cell(const TableCell& cell) {
  if (cell.text == kNoValue) return "--";
  if (cell.text == kFailedMark) return "$\\times$";
  const char* color = cell.mark == Mark::kBest           ? "\\cellcolor{red!35}"
                      : cell.mark == Mark::kSecond       ? "\\cellcolor{orange!35}"
                      : cell.mark == Mark::kBestUntested ? "\\cellcolor{gray!25}"
                                                         : "";
  return with_band(color + latex_number(escaped_latex(cell.text)), cell, latex_number(escaped_latex(cell.band)));
}

std::string latex_row(const std::vector<std::string>& cells) {
  std::string row;
  for (const std::string& cell : cells) row += (row.empty() ? "  " : " & ") + (cell.empty() ? "{}" : cell);
  return row + " \\\\\n";
}

/// As wide as it is, where the column or page has the room.
constexpr const char* kShrunkToColumn = "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n";

std::string latex_table(const ScoreTable& table) {
  const Lines lines = lines_of(table, escaped_latex, latex_cell);
  std::string text = fmt::format(
      "\\begin{{table}}[t]\n\\centering\n{}{}\\begin{{tabular}}{{{}{}}}\n\\toprule\n",
      table.title.empty() ? "" : fmt::format("\\caption{{{}}}\n", escaped_latex(table.title)), kShrunkToColumn,
      std::string(table.head_columns.size(), 'l'), std::string(table.value_columns.size(), 'r'));
  text += latex_row(lines.front()) + "\\midrule\n";
  for (std::size_t i = 1; i < lines.size(); ++i) text += latex_row(lines[i]);
  text += "\\bottomrule\n\\end{tabular}}\n";
  for (const std::string& note : table.notes)
    text += fmt::format("\\par\\smallskip{{\\footnotesize {}}}\n", escaped_latex(note));
  return text + "\\end{table}\n";
}

/// What the tables say below themselves, each note once.
std::vector<std::string> notes_of(const std::vector<ScoreTable>& tables) {
  std::vector<std::string> notes;
  for (const ScoreTable& table : tables) {
    for (const std::string& note : table.notes) {
      if (std::ranges::count(notes, note) == 0) notes.push_back(note);
    }
  }
  return notes;
}

}  // namespace

std::string marks_note(TableFormat format, bool is_plain) {
  const bool has_signs = format != TableFormat::kLatex;
  const std::string untested =
      is_plain ? "" : fmt::format(", {} best by value alone, not tested", has_signs ? "?" : "gray");
  switch (format) {
    case TableFormat::kText:
      return "* best, + second best" + untested;
    case TableFormat::kMarkdown:
      return "bold best, italic second best" + untested;
    case TableFormat::kLatex:
      break;
  }
  return "red best, orange second best" + untested;
}

std::string missing_note(TableFormat format) { return format == TableFormat::kLatex ? "-- no value" : "- no value"; }

std::string typeset(const std::vector<ScoreTable>& tables, TableFormat format) {
  std::string text =
      format == TableFormat::kLatex ? "% needs \\usepackage{booktabs,graphicx} and \\usepackage[table]{xcolor}\n" : "";
  for (const ScoreTable& table : tables) {
    if (&table != &tables.front()) text += "\n";
    text += format == TableFormat::kText       ? text_table(table)
            : format == TableFormat::kMarkdown ? markdown_table(table)
                                               : latex_table(table);
  }
  if (format == TableFormat::kLatex) return text;
  const std::vector<std::string> notes = notes_of(tables);
  if (!notes.empty()) text += "\n";
  for (const std::string& note : notes) {
    text += format == TableFormat::kText ? one_line(note) + "\n" : fmt::format("- {}\n", escaped_markdown(note));
  }
  return text;
}

}  // namespace cmap
