#include <fmt/format.h>

#include <algorithm>

#include "cmap/report/report.hpp"
#include "cmap/report/table_text.hpp"
#include "fairness_table.hpp"
#include "levels_table.hpp"
#include "table_row.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(const Json& value) { return value.is_number() ? hundredths(value) + " %" : digits(value); }

std::string_view arrow(const Json& metric) {
  const Json& better = metric.at("better");
  return better == "lower" ? "↓" : better == "higher" ? "↑" : " ";
}

/// A row of the metric, without its value.
TableRow row_of(std::string_view title, const Json& metric, const std::string& unit) {
  return {.title = title, .symbol = metric.at("symbol").get<std::string>(), .arrow = arrow(metric), .unit = unit};
}

std::string meters(const Json& v) { return fmt::format("{} m", v.get<double>()); }

/// Reports of before left voxels of one point out and did not say how many there are.
std::string consistency_remark(const Json& metric) {
  const Json& parameters = metric.at("parameters");
  const std::string voxels =
      fmt::format("{} voxels of {}", with_thousands(metric.at("n_voxels")), meters(parameters.at("voxel_m")));
  if (parameters.value("singletons", "exclude") == "exclude") {
    return fmt::format("{}, >= {} points", voxels, parameters.at("min_points").get<std::uint64_t>());
  }
  return fmt::format("{}, {} of one point as 0; without them {}", voxels, with_thousands(metric.at("n_singletons")),
                     digits(metric.at("exclude")));
}

/// The reference's own value; a map alone has none beside it.
std::string reference_remark(const Json& metric) {
  return metric.contains("reference") ? fmt::format(", reference {}", digits(metric.at("reference").at("value"))) : "";
}

/// What a reader needs beside the value: the parameters that matter, or a second number that belongs to it.
std::string remark(const MetricInfo& info, const Json& metric) {
  const Json& parameters = metric.at("parameters");
  if (metric.at("value").is_null()) return "";
  if (info.id == "color_distance") return fmt::format("{} of 255", digits(metric.at("value_8bit")));
  if (info.id == "local_color_recall") {
    return fmt::format("coverage {}, of it {}   tau {}, r {}", percent(metric.at("coverage")),
                       percent(metric.at("conditional")), parameters.at("tau").get<double>(),
                       meters(parameters.at("radius_m")));
  }
  if (info.id == "color_consistency") return consistency_remark(metric);
  if (info.id == "average_wasserstein" || info.id == "color_wasserstein") {
    return fmt::format("{} voxels of {}, >= {} points", with_thousands(metric.at("n_voxels")),
                       meters(parameters.at("voxel_m")), parameters.at("min_points").get<std::uint64_t>());
  }
  if (info.id == "spatial_consistency")
    return fmt::format("within {} voxels", parameters.at("radius_voxels").get<int>());
  if (info.id == "overlap") return fmt::format("within {}", meters(parameters.at("overlap_distance_m")));
  if (info.id == "rmse") return fmt::format("inliers {}", digits(metric.at("inlier_rmse")));
  if (info.id == "chamfer") {
    return fmt::format("estimate {} + reference {}", digits(metric.at("estimate_to_reference")),
                       digits(metric.at("reference_to_estimate")));
  }
  if (info.id == "hausdorff") return fmt::format("95 %: {}", digits(metric.at("estimate_to_reference").at("p95")));
  if (info.id == "mean_map_entropy") {
    const Json n_flat = metric.value("n_flat", Json(0));
    return fmt::format("r {}{}{}", meters(parameters.at("radius_m")), reference_remark(metric),
                       n_flat == 0 ? "" : fmt::format(", {} flat left out", with_thousands(n_flat)));
  }
  if (info.id == "point_spacing") {
    return fmt::format("{} places, mean {}{}", with_thousands(metric.at("n")), digits(metric.at("mean")),
                       reference_remark(metric));
  }
  return "";
}

/// Heading of the column of one threshold.
std::string threshold_label(const Json& entry) {
  return fmt::format("{:>10}", fmt::format("<= {}", meters(entry.at("threshold_m"))));
}

/// The value of each entry under its threshold.
template <class ValueOf>
std::string threshold_columns(const MetricInfo& info, const Json& metric, ValueOf&& value_of) {
  std::string columns;
  for (const Json& entry : metric.at("per_threshold"))
    columns += fmt::format(" {:>{}}", shown(info, value_of(entry)), threshold_label(entry).size());
  return columns;
}

std::string threshold_rows(const MetricInfo& info, const Json& metric, const TableLayout& layout) {
  TableRow row = row_of(info.title, metric, shown_unit(info));
  row.value = threshold_columns(info, metric, [](const Json& entry) { return entry.at("value"); });
  std::string rows = format_row(row, layout.width);
  if (layout.levels && metric.at("per_threshold").front().contains("floor")) {
    const auto floor_of = [](const Json& entry) { return entry.at("floor").at("value"); };
    rows += format_row({.title = "  floor", .value = threshold_columns(info, metric, floor_of), .unit = row.unit},
                       layout.width);
  }
  return rows;
}

std::string range_rows(const MetricInfo& info, const Json& metric) {
  std::string rows;
  for (const Json& bin : metric.at("per_range")) {
    const std::string title =
        fmt::format("CD at {} to {} m", bin.at("lo_m").get<double>(), bin.at("hi_m").get<double>());
    TableRow row = row_of(title, metric, shown_unit(info));
    row.value = digits(bin.at("value"));
    rows += format_row(row, 0);
  }
  return rows;
}

std::string value_rows(const Json& report, const MetricInfo& info, const Json& metric, const TableLayout& layout) {
  if (metric.contains("per_threshold")) return threshold_rows(info, metric, layout);
  if (metric.contains("per_range")) return range_rows(info, metric);
  TableRow row = row_of(info.title, metric, shown_unit(info));
  row.value = is_infinite(report, info.id) ? "infinity" : shown(info, metric.at("value"));
  if (layout.levels) row.levels = level_columns(info, metric);
  row.remark = remark(info, metric);
  const std::string phases = phases_text(metric);
  if (!row.remark.empty() && !phases.empty()) row.remark += "; ";
  row.remark += phases;
  return format_row(row, layout.width);
}

/// The thresholds above the columns of the metrics that have one value for each.
std::string threshold_line(const Json& metric) {
  std::string line(44, ' ');  // where row() puts the value
  for (const Json& entry : metric.at("per_threshold")) line += fmt::format(" {}", threshold_label(entry));
  return line + "\n";
}

std::string input_line(const char* which, const Json& input) {
  const Json& n = input.at("finite_points");
  return fmt::format("{:<9} {}: {} point{}, {}, color {}\n", which, input.at("path").get<std::string>(),
                     with_thousands(n), n == 1 ? "" : "s", input.at("format").get<std::string>(),
                     input.at("color").get<std::string>());
}

std::string input_lines(const Json& inputs) {
  if (!inputs.contains("reference")) return input_line("map", inputs.at("estimate"));
  return input_line("reference", inputs.at("reference")) + input_line("estimate", inputs.at("estimate"));
}

std::string alias_lines(const std::string& prefix, const Json& value) {
  if (value.is_object()) {
    std::string lines;
    for (const auto& [key, item] : value.items()) {
      lines += alias_lines(key == "per_threshold" ? prefix : fmt::format("{} {}", prefix, key), item);
    }
    return lines;
  }
  if (value.is_array() && !value.empty() && value.front().is_object()) {
    std::string lines;
    for (const Json& entry : value) {
      const char* threshold = entry.contains("threshold") ? "threshold" : "threshold_m";
      const std::string at = fmt::format("{} @ {}", prefix, meters(entry.at(threshold)));
      for (const auto& [key, item] : entry.items()) {
        if (key != threshold) lines += alias_lines(fmt::format("{} {}", at, key), item);
      }
    }
    return lines;
  }
  constexpr int kDigits = 10;  // what such tools print, at most
  const std::string text = value.is_string()         ? value.get<std::string>()
                           : value.is_number_float() ? fmt::format("{:.{}g}", value.get<double>(), kDigits)
                           : value.is_null()         ? "no value"
                                                     : value.dump();
  return fmt::format(" {} {}\n", padded(prefix, 41), text);
}

/// Names of the columns beside a group's name, where its metrics have levels.
std::string group_line(const Json& metrics, std::string_view group, const TableLayout& layout) {
  const std::string name(group == "mme" ? "entropy" : group);
  const auto in_columns = [&](const Metric* known) {
    const MetricInfo& info = known->info;
    return info.group == group && !info.per_threshold && metrics.contains(info.id) && has_levels(metrics.at(info.id));
  };
  if (!layout.levels || std::ranges::none_of(metric_list(), in_columns)) return fmt::format("\n{}\n", name);
  std::string heading = format_row({.title = {}, .value = "value", .levels = level_heading()}, 0);
  return fmt::format("\n{}", heading.replace(0, name.size(), name));
}

std::string metric_lines(const Json& report, const TableLayout& layout) {
  const Json& metrics = report.at("metrics");
  std::string lines;
  std::string_view group;
  bool thresholds_shown = false;
  for (const Metric* known : metric_list()) {
    const MetricInfo& info = known->info;
    if (!metrics.contains(info.id)) continue;
    if (info.group != group) lines += group_line(metrics, info.group, layout);
    group = info.group;
    const Json& metric = metrics.at(info.id);
    if (info.per_threshold && !thresholds_shown) lines += threshold_line(metric);
    thresholds_shown = info.per_threshold;
    lines += value_rows(report, info, metric, layout);
  }
  return lines;
}

}  // namespace

std::string format_table(const Json& report, const TableLayout& asked) {
  TableLayout layout = asked;
  layout.levels = asked.levels && std::ranges::any_of(report.at("metrics"), has_levels);
  std::string table = input_lines(report.at("inputs")) + metric_lines(report, layout);
  if (layout.levels) table += missing_level_lines(report);
  if (report.contains("aliases")) {
    for (const auto& [tool, record] : report.at("aliases").items())
      table += fmt::format("\nas {}\n{}", tool, alias_lines("", record));
  }
  table += alignment_lines(report) + sensitivity_lines(report) + interval_lines(report) + unobserved_lines(report);
  const Json& warnings = report.at("warnings");
  if (!warnings.empty()) table += "\nwarnings\n";
  for (const Json& warning : warnings) {
    table += fmt::format("  {}: {}\n", warning.at("id").get<std::string>(), warning.at("message").get<std::string>());
  }
  return table;
}

}  // namespace cmap
