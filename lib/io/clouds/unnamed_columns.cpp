#include "clouds/unnamed_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "clouds/color_store.hpp"

namespace cmap {
namespace {

/// What may follow x y z: r red, green and blue; n a normal; a alpha; i intensity, label, curvature.
constexpr std::string_view kLayouts[] = {"r",   "n",   "ra",  "ri",  "ir", "rn", "nr",
                                         "irn", "ran", "nra", "nri", "ni", "in"};

std::size_t width_of(char role) { return role == 'r' || role == 'n' ? 3 : 1; }

std::size_t width_of(std::string_view layout) {
  std::size_t width = 0;
  for (const char role : layout) width += width_of(role);
  return width;
}

/// What three neighboring columns hold, over all rows.
struct ColumnStatistics {
  double lowest = 0.0, highest = 0.0;
  bool fractions = false;
  bool unit_or_zero = true;  ///< the length of every row is 1 (as far as few digits say) or 0
  bool alike = true;         ///< not fractions beside whole numbers above one (intensity, ring, time)
  bool one_scale = true;     ///< not whole numbers of 8 bits beside larger ones
};

/// One column of a triple.
struct Channel {
  double lowest, highest;
  bool fractions = false;

  bool is_constant() const { return lowest == highest; }
};

Channel measure_channel(const NumberTable& table, std::size_t column) {
  Channel channel{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double v = table.at(row, column);
    if (!std::isfinite(v)) continue;
    channel.lowest = std::min(channel.lowest, v);
    channel.highest = std::max(channel.highest, v);
    channel.fractions = channel.fractions || v != std::floor(v);
  }
  return channel;
}

/// Whether channels are alike, which those of colors are; of a few rows, or of one value throughout, nobody can say.
void compare_channels(const NumberTable& table, std::size_t first, ColumnStatistics& triple) {
  constexpr std::size_t kFewRows = 8;
  constexpr double kWhite8 = 255.0;
  // Fractions may overshoot white.
  const auto is_small = [&](const Channel& channel) {
    return channel.highest <= (channel.fractions ? kColorOvershoot * kWhite8 : kWhite8);
  };
  if (table.rows() < kFewRows) return;
  bool any_fractions = false, any_whole = false, any_small = false, any_large = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Channel channel = measure_channel(table, first + k);
    if (channel.is_constant()) continue;
    any_fractions = any_fractions || channel.fractions;
    any_whole = any_whole || (!channel.fractions && channel.highest > 1.0);
    any_small = any_small || is_small(channel);
    any_large = any_large || !is_small(channel);
  }
  triple.alike = !(any_fractions && any_whole);
  triple.one_scale = !(any_small && any_large);
}

ColumnStatistics measure(const NumberTable& table, std::size_t first) {
  constexpr double kTolerance = 0.02;  // three numbers of two digits after the point
  ColumnStatistics triple;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    double sq_length = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = table.at(row, first + k);
      if (!std::isfinite(v)) continue;
      triple.lowest = std::min(triple.lowest, v);
      triple.highest = std::max(triple.highest, v);
      triple.fractions = triple.fractions || v != std::floor(v);
      sq_length += v * v;
    }
    triple.unit_or_zero =
        triple.unit_or_zero && (sq_length == 0.0 || std::abs(std::sqrt(sq_length) - 1.0) < kTolerance);
  }
  compare_channels(table, first, triple);
  return triple;
}

bool may_be_color(const ColumnStatistics& t) {
  constexpr double kHighestColor = 65535.0;
  const double highest = t.fractions ? kColorOvershoot * kHighestColor : kHighestColor;
  if (t.lowest < 0.0 || t.highest > highest || t.highest == 0.0) return false;
  return t.alike && !(t.unit_or_zero && t.fractions);  // colors would not all have length 1
}

bool may_be_alpha(const NumberTable& table, std::size_t column) {
  const double first = table.at(0, column);
  if (first != 1.0 && first != 255.0 && first != 65535.0) return false;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.at(row, column) != first) return false;
  }
  return true;
}

bool fits(const NumberTable& table, std::string_view layout) {
  if (width_of(layout) + 3 != table.columns) return false;
  std::size_t column = 3;
  for (const char role : layout) {
    const ColumnStatistics triple = width_of(role) == 3 ? measure(table, column) : ColumnStatistics();
    const bool fit = role == 'r'   ? may_be_color(triple) && (layout == "r" || triple.one_scale)
                     : role == 'n' ? triple.unit_or_zero
                     : role == 'a' ? may_be_alpha(table, column)
                                   : true;
    if (!fit) return false;
    column += width_of(role);
  }
  return true;
}

/// Of several layouts those that `is_likelier` holds for, if there are any.
template <class Test>
void prefer(Test&& is_likelier, std::vector<std::string_view>& layouts) {
  if (std::any_of(layouts.begin(), layouts.end(), is_likelier)) {
    std::erase_if(layouts, [&](std::string_view layout) { return !is_likelier(layout); });
  }
}

std::size_t place_of_color(std::string_view layout) {
  const std::size_t at = layout.find('r');
  return at == std::string_view::npos ? 0 : 3 + width_of(layout.substr(0, at));
}

std::string column_range(const NumberTable& table, std::size_t first, std::size_t last) {
  first += table.n_before;
  last += table.n_before;
  return first == last ? fmt::format("column {}", first) : fmt::format("columns {} to {}", first, last);
}

void note_ignored(const NumberTable& table, FileInfo& info) {
  const bool one = table.columns == 4;
  info.notes.push_back(fmt::format("{} ignored; names such as 'x y z r g b' would say what {}",
                                   column_range(table, 4, table.columns), one ? "it holds" : "they hold"));
}

void note_others(const NumberTable& table, std::size_t color, FileInfo& info) {
  std::vector<std::string> unused;
  if (color > 3) unused.push_back(column_range(table, 4, color));
  if (color + 3 < table.columns) unused.push_back(column_range(table, color + 4, table.columns));
  for (const std::string& columns : unused) info.notes.push_back(columns + " not used");
}

}  // namespace

std::optional<ColumnTriple> find_unnamed_colors(const NumberTable& table, bool intensity_first, FileInfo& info) {
  if (table.columns <= 3 || table.rows() == 0) return std::nullopt;
  std::vector<std::string_view> fitting;
  for (const std::string_view layout : kLayouts) {
    if (fits(table, layout)) fitting.push_back(layout);
  }
  // A column that is alpha throughout would be a strange blue or intensity, but for a kind of file that has
  // intensities.
  prefer([&](std::string_view l) { return intensity_first ? l.starts_with('i') : l.find('a') != l.npos; }, fitting);
  if (fitting.empty()) {
    note_ignored(table, info);
    return std::nullopt;
  }
  if (fitting.size() > 1) {
    info.warnings.push_back(
        {"undecidable_columns",
         fmt::format("no color taken: {} can be read in more than one way (colors, normals, intensity); "
                     "names such as 'x y z r g b' would say which they are",
                     column_range(table, 4, table.columns))});
    return std::nullopt;
  }
  const std::size_t color = place_of_color(fitting[0]);
  if (color == 0) {
    info.notes.push_back(fmt::format(
        "no color: {} taken as a normal{}", column_range(table, 4, table.columns),
        measure(table, 3).highest == 0.0 && measure(table, 3).lowest == 0.0 ? " that is zero throughout" : ""));
    return std::nullopt;
  }
  info.notes.push_back(fmt::format("{} taken as red, green and blue", column_range(table, color + 1, color + 3)));
  note_others(table, color, info);
  return ColumnTriple{color, color + 1, color + 2};
}

RowNumbers find_row_numbers(const NumberTable& table) {
  constexpr std::size_t kFewest = 8, kColorsOrNormals = 6;
  if (table.columns < 4 || table.rows() < kFewest) return RowNumbers::kNone;
  const double first = table.at(0, 0);
  if (first != 0.0 && first != 1.0) return RowNumbers::kNone;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.at(row, 0) != first + table.row_step * static_cast<double>(row)) return RowNumbers::kNone;
  }
  // Coordinates do not stand still in a map; those of one line of a raster do.
  if (measure_channel(table, 1).is_constant() || measure_channel(table, 2).is_constant()) return RowNumbers::kNone;
  if (table.columns == kColorsOrNormals && (fits(table, "r") || fits(table, "n"))) return RowNumbers::kNone;
  const auto has_fractions = [&](std::size_t column) { return measure_channel(table, column).fractions; };
  return has_fractions(1) && has_fractions(2) && has_fractions(3) ? RowNumbers::kCertain : RowNumbers::kUndecidable;
}

NumberTable without_first_column(const NumberTable& table) {
  NumberTable rest{table.columns - 1, {}, table.row_step, table.n_before + 1};
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t column = 1; column < table.columns; ++column) rest.values.push_back(table.at(row, column));
  }
  return rest;
}

}  // namespace cmap
