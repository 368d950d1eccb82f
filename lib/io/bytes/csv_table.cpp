#include "bytes/csv_table.hpp"

#include <cmath>
#include <utility>

#include "cmap/io/number_text.hpp"

namespace cmap {

CsvTable::CsvTable(ByteSource& source, std::initializer_list<std::string_view> columns)
    : lines_(source), columns_(columns) {
  std::string_view line;
  if (lines_.next(line)) split(line);
  if (cells_ != columns_) lines_.fail("the columns {} expected", fmt::join(columns_, ","));
}

void CsvTable::split(std::string_view line) {
  cells_.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    cells_.push_back(without_blanks(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

bool CsvTable::next() {
  std::string_view line;
  do {
    if (!lines_.next(line)) return false;
  } while (without_blanks(line).empty());
  split(line);
  if (cells_.size() != columns_.size()) {
    lines_.fail("{} cells; the {} of {} expected", cells_.size(), columns_.size(), fmt::join(columns_, ","));
  }
  return true;
}

double CsvTable::number(std::size_t column) const {
  double value = 0.0;
  if (!parse_number(cells_[column], value)) {
    lines_.fail("{} is '{}', not a number", columns_[column], cells_[column].substr(0, 40));
  }
  if (!std::isfinite(value)) lines_.fail("{} is '{}', not finite", columns_[column], cells_[column]);
  return value;
}

std::uint64_t CsvTable::whole_number(std::size_t column) const {
  unsigned long long value = 0;
  if (!parse_number(cells_[column], value)) {
    lines_.fail("{} is '{}', not a whole number", columns_[column], cells_[column].substr(0, 40));
  }
  return value;
}

bool CsvTable::for_each_row(const Faults& faults, const std::function<void()>& read_row) {
  constexpr std::size_t kMostFaults = 10;
  std::size_t n_faults = 0;
  for (bool is_row = true; is_row;) {
    const std::uint64_t place = lines_.source().position();
    const bool is_good = faults.attempt([&] {
      is_row = next();
      if (is_row) read_row();
    });
    if (is_good) continue;
    if (lines_.source().position() == place) return false;  // a line too long to step over
    if (++n_faults < kMostFaults) continue;
    faults.attempt([&] { lines_.fail("{} rows are faulty so far; the rest was not read", n_faults); });
    return false;
  }
  return n_faults == 0;
}

void IncreasingTimes::add(const LineReader& lines, double time_s) {
  const bool is_after = !any_ || time_s > last_s_;
  const double before_s = std::exchange(last_s_, time_s);
  any_ = true;
  if (!is_after) lines.fail("time {} s is not after the {} s before it", time_s, before_s);
}

}  // namespace cmap
