#include "fairness_table.hpp"

#include <fmt/format.h>

#include <functional>

#include "cmap/report/table_text.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

std::string line(const MetricInfo& info, const std::string& title, const std::string& value) {
  const std::string text =
      fmt::format("  {} {} {} {}", padded(title, 30), padded(info.symbol, 10), value, shown_unit(info));
  return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
}

std::string span_text(const MetricInfo& info, const Json& from, const Json& to) {
  return fmt::format("{:>10} to {:>10}", shown(info, from), shown(info, to));
}

/// One line for each value of these metrics, in the catalog's order.
std::string lines(const Json& metrics, const std::function<std::string(const MetricInfo&, const Json&)>& text_of) {
  std::string result;
  for (const Metric* known : metric_list()) {
    const MetricInfo& info = known->info;
    if (!metrics.contains(info.id)) continue;
    const Json& metric = metrics.at(info.id);
    if (!metric.contains("per_threshold")) {
      result += line(info, std::string(info.title), text_of(info, metric));
      continue;
    }
    for (const Json& entry : metric.at("per_threshold")) {
      const double threshold_m = entry.at("threshold_m").get<double>();
      result += line(info, fmt::format("{} <= {} m", info.title, threshold_m), text_of(info, entry));
    }
  }
  return result;
}

}  // namespace

std::string alignment_lines(const Json& report) {
  const Json& alignment = report.at("alignment");
  if (alignment.is_null() || alignment.at("registration").is_null()) return "";
  const Json& registration = alignment.at("registration");
  const std::string verdict = registration.value("verdict", "not judged");
  return fmt::format("\nbefore the alignment by {} ({}scale error {:.4g} %, {} iterations, overlap {} %)\n",
                     alignment.at("method").get<std::string>(), verdict == "not judged" ? "" : verdict + ", ",
                     100.0 * alignment.at("scale_error").get<double>(), registration.at("iterations").get<int>(),
                     hundredths(registration.at("overlap"))) +
         lines(alignment.at("before"), [](const MetricInfo& info, const Json& entry) {
           return fmt::format("{:>10}", shown(info, entry.value("value", Json(nullptr))));
         });
}

std::string sensitivity_lines(const Json& report) {
  if (!report.contains("sensitivity")) return "";
  const Json& sensitivity = report.at("sensitivity");
  return fmt::format("\nwhen the estimate is off by {} m or {} degrees\n",
                     sensitivity.at("translation_m").get<double>(), sensitivity.at("rotation_deg").get<double>()) +
         lines(sensitivity.at("metrics"), [](const MetricInfo& info, const Json& entry) {
           return span_text(info, entry.at("lowest"), entry.at("highest"));
         });
}

std::string interval_lines(const Json& report) {
  if (!report.contains("intervals")) return "";
  const Json& intervals = report.at("intervals");
  return fmt::format("\n{} % intervals, {} replicates of {} blocks of {} m\n",
                     100.0 * intervals.at("level").get<double>(), intervals.at("replicates").get<std::uint64_t>(),
                     intervals.at("n_blocks").get<std::uint64_t>(),
                     intervals.at("blocks").at("block_m").get<double>()) +
         lines(intervals.at("metrics"), [](const MetricInfo& info, const Json& entry) {
           return span_text(info, entry.at("lower"), entry.at("upper"));
         });
}

std::string unobserved_lines(const Json& report) {
  if (!report.contains("unobserved")) return "";
  const Json& unobserved = report.at("unobserved");
  const auto share = [&](const char* map) { return hundredths(unobserved.at(map).at("share_unobserved")); };
  return fmt::format("\nwithout what the other map could not have seen: {} % of the estimate, {} % of the reference\n",
                     share("estimate"), share("reference")) +
         lines(unobserved.at("metrics"), [](const MetricInfo& info, const Json& entry) {
           return fmt::format("{:>10}", shown(info, entry.at("value")));
         });
}

}  // namespace cmap
