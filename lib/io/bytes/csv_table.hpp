#pragma once

#include <functional>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "cmap/io/faults.hpp"
#include "cmap/io/line_reader.hpp"

namespace cmap {

/// The rows of a table with a header line, cells separated by commas, blanks around them dropped; nothing is quoted.
class CsvTable {
 public:
  /// Reads the header line. Throws InputError unless it names these columns in this order.
  CsvTable(ByteSource& source, std::initializer_list<std::string_view> columns);

  /// The next row that is not blank; false at the end. Throws InputError for another number of cells.
  bool next();
  /// Calls read_row() for each of the rows that are left. What is wrong with a row goes to `faults`, of ten at most;
  /// true if nothing is.
  bool for_each_row(const Faults& faults, const std::function<void()>& read_row);
  std::string_view cell(std::size_t column) const { return cells_[column]; }
  /// The cell as a finite number, or as a whole one; throws InputError naming line and column for anything else.
  double number(std::size_t column) const;
  std::uint64_t whole_number(std::size_t column) const;
  const LineReader& lines() const { return lines_; }

 private:
  void split(std::string_view line);

  LineReader lines_;
  std::vector<std::string_view> columns_;
  std::vector<std::string_view> cells_;
};

/// Throws InputError where a time does not come after the one before it, which may be faulty itself.
class IncreasingTimes {
 public:
  void add(const LineReader& lines, double time_s);

 private:
  bool any_ = false;
  double last_s_ = 0.0;
};

}  // namespace cmap
