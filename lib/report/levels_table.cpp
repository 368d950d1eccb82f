#include "levels_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cmap/report/table_text.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLevels[] = {"floor", "chance", "skill"};

std::string columns(const std::string& floor, const std::string& chance, const std::string& skill) {
  return fmt::format(" {:>10} {:>10} {:>8}", floor, chance, skill);
}

/// Skills are compared down their column: all with as many decimals.
std::string skill_text(const Json& value) {
  const bool fits = value.is_number() && std::abs(value.get<double>()) < 100.0;
  return fits ? fmt::format("{:.3f}", value.get<double>()) : digits(value);
}

/// Levels without a value for one reason.
struct Missing {
  std::string level, reason;
  std::vector<std::string> names;
};

void add_missing(const std::string& level, const std::string& reason, const std::string& name,
                 std::vector<Missing>& all) {
  const auto same = [&](const Missing& missing) { return missing.level == level && missing.reason == reason; };
  auto place = std::ranges::find_if(all, same);
  if (place == all.end()) place = all.insert(all.end(), {level, reason, {}});
  place->names.push_back(name);
}

std::string reason_of(const Json& level) { return level.value("reason", "no reason given"); }

bool is_missing(const Json& record, const std::string& level) {
  return record.contains(level) && record.at(level).at("value").is_null();
}

/// The floors at thresholds: of all of them at once where they lack it alike.
void add_missing_floors(const Json& entries, const std::string& name, std::vector<Missing>& all) {
  const auto like_first = [&](const Json& entry) {
    return is_missing(entry, "floor") && reason_of(entry.at("floor")) == reason_of(entries.front().at("floor"));
  };
  if (std::ranges::all_of(entries, like_first)) {
    add_missing("floor", reason_of(entries.front().at("floor")), name, all);
    return;
  }
  for (const Json& entry : entries) {
    if (!is_missing(entry, "floor")) continue;
    const std::string at = fmt::format("{} at {} m", name, entry.at("threshold_m").get<double>());
    add_missing("floor", reason_of(entry.at("floor")), at, all);
  }
}

std::vector<Missing> missing_levels(const Json& metrics) {
  std::vector<Missing> all;
  for (const Metric* known : metric_list()) {
    const MetricInfo& info = known->info;
    if (!metrics.contains(info.id)) continue;
    const Json& metric = metrics.at(info.id);
    const std::string name(info.symbol.empty() ? info.title : info.symbol);
    if (metric.contains("per_threshold")) add_missing_floors(metric.at("per_threshold"), name, all);
    for (const char* level : kLevels) {
      if (is_missing(metric, level)) add_missing(level, reason_of(metric.at(level)), name, all);
    }
  }
  return all;
}

}  // namespace

bool has_levels(const Json& metric) {
  const auto has_one = [](const Json& record) {
    return std::ranges::any_of(kLevels, [&](const char* level) { return record.contains(level); });
  };
  return has_one(metric) || (metric.contains("per_threshold") && has_one(metric.at("per_threshold").front()));
}

std::string level_heading() { return columns("floor", "chance", "skill"); }

std::string level_columns(const MetricInfo& info, const Json& metric) {
  const auto text = [&](const char* level, auto&& format) {
    return metric.contains(level) ? format(metric.at(level).at("value")) : std::string();
  };
  const auto as_value = [&](const Json& value) { return shown(info, value); };
  return columns(text("floor", as_value), text("chance", as_value), text("skill", skill_text));
}

std::string phases_text(const Json& metric) {
  const Json phases = metric.value("phases", Json::object());
  if (phases.value("n", 0) == 0) return "";
  const double mean = phases.at("mean").get<double>(), std = phases.at("std").get<double>();
  const std::size_t n = phases.at("n").get<std::size_t>(), n_grids = phases.at("values").size();
  // Two digits of the deviation say how many of the mean mean something.
  const int decimals = std > 0.0 ? std::max(0, 1 - static_cast<int>(std::floor(std::log10(std)))) : 0;
  const bool readable = std > 0.0 && decimals <= 6;
  const std::string band = readable ? fmt::format("{:.{}f} ± {:.{}f}", mean, decimals, std, decimals)
                                    : fmt::format("{} ± {}", digits(mean), digits(std));
  return fmt::format("{} over {} grids", band,
                     n == n_grids ? fmt::format("{}", n) : fmt::format("{} of {}", n, n_grids));
}

std::string missing_level_lines(const Json& report) {
  std::string lines;
  for (const Missing& missing : missing_levels(report.at("metrics"))) {
    lines += fmt::format("  {} of {}: {}\n", missing.level, fmt::join(missing.names, ", "), missing.reason);
  }
  return lines.empty() ? "" : "\nlevels without a value\n" + lines;
}

}  // namespace cmap
