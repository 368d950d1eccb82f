#include "captures/kitti_times.hpp"

#include <fmt/format.h>

#include <chrono>
#include <optional>

#include "cmap/core/error.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/line_reader.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

/// Digits alone.
std::optional<int> whole(std::string_view text) {
  int value = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    value = 10 * value + (c - '0');
  }
  return text.empty() ? std::nullopt : std::optional(value);
}

/// "2011-09-26 13:02:25.594360375"; none: it is not of this form.
std::optional<double> seconds_of(std::string_view text) {
  constexpr std::size_t kShortest = 19;
  if (text.size() < kShortest || text[4] != '-' || text[7] != '-' || text[10] != ' ' || text[13] != ':' ||
      text[16] != ':') {
    return std::nullopt;
  }
  const auto year = whole(text.substr(0, 4)), month = whole(text.substr(5, 2)), day = whole(text.substr(8, 2));
  const auto hour = whole(text.substr(11, 2)), minute = whole(text.substr(14, 2));
  double second = 0.0;
  if (!year || !month || !day || !hour || !minute || !parse_number(text.substr(17), second)) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok() || *hour > 23 || *minute > 59 || !(second >= 0.0 && second < 61.0)) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600.0 * *hour + 60.0 * *minute + second;
}

}  // namespace

std::vector<double> read_kitti_times(const std::filesystem::path& path) {
  ByteSource source(path);
  LineReader lines(source);
  std::vector<double> times;
  std::string_view line;
  while (lines.next(line)) {
    while (!line.empty() && (line.back() == ' ' || line.back() == '\r')) line.remove_suffix(1);
    if (line.empty()) continue;
    const std::optional<double> time_s = seconds_of(line);
    if (!time_s) lines.fail("'{}' is no time like 2011-09-26 13:02:25.594360375", line.substr(0, 40));
    times.push_back(*time_s);
  }
  return times;
}

std::size_t kitti_number(const std::filesystem::path& path) {
  constexpr std::size_t kMostDigits = 18;
  const std::string name = path.stem().string();
  std::size_t number = 0;
  for (const char c : name) {
    if (c < '0' || c > '9' || name.size() > kMostDigits) {
      throw InputError(path.string() + ": the name is no number, as 0000000012 is");
    }
    number = 10 * number + static_cast<std::size_t>(c - '0');
  }
  return number;
}

}  // namespace cmap
