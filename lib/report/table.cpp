#include <fmt/format.h>

#include <algorithm>

#include "cmap/report/report.hpp"
#include "cmap/report/table_text.hpp"
#include "fairness_table.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(const Json& value) { return value.is_number() ? hundredths(value) + " %" : digits(value); }

std::string_view arrow(const Json& metric) {
  const Json& better = metric.at("better");
  return better == "lower" ? "↓" : better == "higher" ? "↑" : " ";
}

std::string row(std::string_view title, const Json& metric, const std::string& value, std::string_view unit,
                const std::string& remark) {
  const std::string symbol = metric.at("symbol").get<std::string>();
  const std::string line = fmt::format("  {} {} {} {} {} {}", padded(title, 30), padded(symbol, 8), arrow(metric),
                                       fmt::format("{:>11}", value), padded(unit, 10), remark);
  return line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
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
  if (info.id == "average_wasserstein") {
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

std::string value_rows(const Json& report, const MetricInfo& info, const Json& metric) {
  const std::string unit = shown_unit(info);
  if (metric.contains("per_threshold")) {
    std::string values;
    for (const Json& entry : metric.at("per_threshold"))
      values += fmt::format(" {:>{}}", shown(info, entry.at("value")), threshold_label(entry).size());
    return row(info.title, metric, values, unit, "");
  }
  if (metric.contains("per_range")) {
    std::string rows;
    for (const Json& bin : metric.at("per_range")) {
      rows += row(fmt::format("CD at {} to {} m", bin.at("lo_m").get<double>(), bin.at("hi_m").get<double>()), metric,
                  digits(bin.at("value")), unit, "");
    }
    return rows;
  }
  const std::string value = is_infinite(report, info.id) ? "infinity" : shown(info, metric.at("value"));
  return row(info.title, metric, value, unit, remark(info, metric));
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

}  // namespace

std::string format_table(const Json& report) {
  std::string table = input_lines(report.at("inputs"));
  std::string_view group;
  bool thresholds_shown = false;
  for (const Metric* known : metric_list()) {
    const MetricInfo& info = known->info;
    if (!report.at("metrics").contains(info.id)) continue;
    if (info.group != group) table += fmt::format("\n{}\n", info.group == "mme" ? "entropy" : info.group);
    group = info.group;
    const Json& metric = report.at("metrics").at(info.id);
    if (info.per_threshold && !thresholds_shown) table += threshold_line(metric);
    thresholds_shown = info.per_threshold;
    table += value_rows(report, info, metric);
  }
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
