// What the columns of a trajectory are called: EuRoC, TUM-VI, ROS, Newer College, evo, pandas, people.

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>

#include "poses/trajectory_layout.hpp"

namespace cmap {
namespace {

enum class Quantity { kOther, kTime, kNanoseconds, kPosition, kQuaternion };

struct TrajectoryColumn {
  Quantity quantity = Quantity::kOther;
  std::size_t axis = 0;  ///< x y z w
  double units_per_s = 0.0;
};

/// Cuts "[ns]" or "(m)" off a name, and gives what was within.
std::string take_unit(std::string& name) {
  const std::size_t begin = name.find_first_of("[(");
  if (begin == std::string::npos) return {};
  const std::size_t end = std::min(name.size(), name.find_first_of("])", begin));
  std::string unit = name.substr(begin + 1, end - begin - 1);
  name.erase(begin, end - begin + 1);
  return unit;
}

/// Lower case; whatever is no letter or digit becomes one '_' between two of them.
std::string plain(std::string_view name) {
  std::string text;
  for (const unsigned char c : name) {
    if (std::isalnum(c) != 0) {
      text += static_cast<char>(std::tolower(c));
    } else if (!text.empty() && text.back() != '_') {
      text += '_';
    }
  }
  while (text.ends_with('_')) text.pop_back();
  return text;
}

/// Cuts "_<word>" off the end.
bool take_suffix(std::string& name, std::string_view word) {
  if (!name.ends_with(word) || name.size() <= word.size() || name[name.size() - word.size() - 1] != '_') return false;
  name.resize(name.size() - word.size() - 1);
  return true;
}

bool holds(std::string_view text, std::string_view word) { return text.find(word) != std::string_view::npos; }

bool is_time(std::string_view name) {
  constexpr std::array<std::string_view, 6> kTimes{"t", "ts", "sec", "secs", "seconds", "s"};
  return std::find(kTimes.begin(), kTimes.end(), name) != kTimes.end() || name.starts_with("time") ||
         name.ends_with("stamp") || name.ends_with("time");
}

bool is_nanoseconds(std::string_view name) {
  return name.ends_with("nsec") || name.ends_with("nsecs") || name.ends_with("nanosec");
}

double units_per_s(std::string& name, std::string unit) {
  // Seconds are so named whatever they are.
  constexpr std::array<std::pair<std::string_view, double>, 6> kUnits{
      {{"ns", 1e9}, {"us", 1e6}, {"ms", 1e3}, {"s", 0.0}, {"sec", 0.0}, {"secs", 0.0}}};
  for (const auto& [word, units] : kUnits) {
    if (unit == word || take_suffix(name, word)) return units;
  }
  return 0.0;
}

std::optional<Quantity> quantity_of(std::string_view base) {
  if (base.starts_with('q') || holds(base, "quat") || holds(base, "orient") || holds(base, "rot")) {
    return Quantity::kQuaternion;
  }
  if (base.empty() || base == "t" || base == "p" || base.starts_with("p_") || holds(base, "pos") ||
      holds(base, "trans")) {
    return Quantity::kPosition;
  }
  return std::nullopt;
}

TrajectoryColumn column_of(std::string_view text) {
  std::string whole(text);
  const std::string unit = plain(take_unit(whole));
  std::string name = plain(whole);
  if (is_nanoseconds(name)) return {Quantity::kNanoseconds, 0, 0.0};
  std::string time = name;
  const double units = units_per_s(time, unit);
  if (is_time(time)) return {Quantity::kTime, 0, units};
  take_suffix(name, "m");
  if (name.empty()) return {};
  const std::size_t axis = std::string_view("xyzw").find(name.back());
  if (axis == std::string_view::npos) return {};
  name.pop_back();
  if (name.ends_with('_')) name.pop_back();
  const auto quantity = quantity_of(name);
  if (!quantity || (*quantity == Quantity::kPosition && axis == 3)) return {};
  return {*quantity, axis, 0.0};
}

/// Cells of a header: between commas or semicolons, where there are any; between blanks otherwise, units apart.
std::vector<std::string> names_of(std::string_view header) {
  std::string text(header);
  const bool by_blanks = text.find_first_of(",;") == std::string::npos;
  if (by_blanks) {
    for (const char* unit : {" [", " ("}) {
      for (std::size_t at; (at = text.find(unit)) != std::string::npos;) text.erase(at, 1);
    }
  }
  std::vector<std::string> names(1);
  for (const char c : text) {
    const bool separates = by_blanks ? std::isspace(static_cast<unsigned char>(c)) != 0 : c == ',' || c == ';';
    if (!separates) {
      names.back() += c;
    } else if (!by_blanks || !names.back().empty()) {
      names.emplace_back();
    }
  }
  if (plain(names.back()).empty() && names.size() > 1) names.pop_back();
  return names;
}

using Places = std::array<std::optional<std::size_t>, 4>;

void place(const LineReader& lines, std::optional<std::size_t>& slot, std::size_t column,
           const std::vector<std::string>& names) {
  if (slot) lines.fail("the header names two columns alike: '{}' and '{}'", names[*slot], names[column]);
  slot = column;
}

bool complete(const Places& places, std::size_t n) {
  return std::all_of(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(n),
                     [](const auto& p) { return p.has_value(); });
}

}  // namespace

std::optional<TrajectoryLayout> trajectory_layout_by_names(const LineReader& lines, std::string_view header,
                                                           std::size_t columns) {
  const std::vector<std::string> names = names_of(header);
  if (names.size() != columns) return std::nullopt;
  TrajectoryLayout layout;
  layout.columns = names.size();
  layout.is_named = true;
  Places position, quaternion;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const TrajectoryColumn column = column_of(names[i]);
    if (column.quantity == Quantity::kPosition) place(lines, position[column.axis], i, names);
    if (column.quantity == Quantity::kQuaternion) place(lines, quaternion[column.axis], i, names);
    if (column.quantity == Quantity::kNanoseconds) place(lines, layout.nanoseconds, i, names);
    // ROS writes when a message came and, as its stamp, when it was measured.
    if (column.quantity == Quantity::kTime && (!layout.time || holds(plain(names[i]), "stamp"))) {
      layout.time = i;
      layout.units_per_s = column.units_per_s;
    }
  }
  if (!complete(position, 3)) return std::nullopt;
  if (!complete(quaternion, 4)) {
    lines.fail("no columns for x, y, z and w of a quaternion among '{}'", fmt::join(names, "', '"));
  }
  if (!layout.time) {
    layout.time = std::exchange(layout.nanoseconds, std::nullopt);
    layout.units_per_s = 1e9;
  }
  if (!layout.time) lines.fail("no column for the time among '{}'", fmt::join(names, "', '"));
  if (layout.nanoseconds) layout.units_per_s = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) layout.pose.push_back(*position[axis]);
  for (std::size_t axis = 0; axis < 4; ++axis) layout.pose.push_back(*quaternion[axis]);
  return layout;
}

}  // namespace cmap
