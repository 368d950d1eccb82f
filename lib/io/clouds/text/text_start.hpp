#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clouds/text/text_row.hpp"
#include "clouds/unnamed_columns.hpp"
#include "cmap/io/line_reader.hpp"

namespace cmap {

struct TextLine {
  std::uint64_t number = 0;  ///< in the file, from 1
  std::string text;
};

/// The start of a text file: everything that decides what its columns are.
struct TextStart {
  std::vector<TextLine> comments;      ///< before the rows, without their marks
  std::optional<TextLine> header;      ///< the line before the rows that is no comment and no numbers
  std::optional<std::uint64_t> count;  ///< of a line that holds nothing but the number of points
  std::vector<TextLine> rows;          ///< the first ones, at most kRows
  RowFormat format;                    ///< theirs
  bool whole = false;                  ///< these are all rows of the file

  static constexpr std::size_t kRows = 1024;
};

/// Throws InputError if there is no row of numbers, or it cannot be cut into columns.
TextStart read_text_start(LineReader& lines);

/// The numbers of the first rows, as many columns as the first has; what is no number, or not there, is NaN.
NumberTable number_table(const TextStart& start);

/// Whether a line holds nothing, or a comment (#, //, %, ! or a lone ;).
bool is_blank_line(std::string_view line);
bool is_comment_line(std::string_view line);

}  // namespace cmap
