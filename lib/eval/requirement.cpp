#include "cmap/eval/requirement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <regex>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/eval/metric_catalog.hpp"

namespace cmap {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& reason) {
  throw UsageError(fmt::format("require \"{}\": {}", text, reason));
}

bool compare(double value, const std::string& comparison, double bound) {
  if (comparison == ">=") return value >= bound;
  if (comparison == "<=") return value <= bound;
  if (comparison == ">") return value > bound;
  if (comparison == "<") return value < bound;
  return value == bound;
}

void check_threshold(const Requirement& requirement, const EvaluationOptions& options) {
  const MetricInfo& metric = *requirement.metric;
  if (!metric.per_threshold) {
    if (requirement.threshold_m) refuse(requirement.text, fmt::format("{} has no thresholds", metric.id));
    return;
  }
  if (!requirement.threshold_m) {
    refuse(requirement.text, fmt::format("{} has one value for each threshold: write {}@{}", metric.id, metric.id,
                                         options.thresholds_m.front()));
  }
  if (std::ranges::count(options.thresholds_m, *requirement.threshold_m) == 0) {
    refuse(requirement.text, fmt::format("{} m is not among the thresholds", *requirement.threshold_m));
  }
}

/// The part of a record that the requirement is about.
const Record& part_of(const Record& record, const Requirement& requirement) {
  if (!requirement.threshold_m) return record;
  for (const Record& level : record.list("per_threshold")) {
    if (level.threshold_m == requirement.threshold_m) return level;
  }
  refuse(requirement.text, "no such threshold");
}

/// The expression alone.
Requirement parse(const std::string& text) {
  static const std::regex kForm(
      R"(\s*([A-Za-z_0-9]+#?)((?:\.[A-Za-z_0-9]+)*)(?:@([0-9.eE+-]+))?\s*(>=|<=|==|>|<)\s*([-+0-9.eE]+)\s*(%?)\s*)");
  std::smatch match;
  if (!std::regex_match(text, match, kForm)) refuse(text, "expected METRIC[@THRESHOLD] >= NUMBER[%] (or <=, >, <, ==)");
  const auto number = [&](const std::string& digits) {
    char* end = nullptr;
    const double value = std::strtod(digits.c_str(), &end);
    if (end != digits.c_str() + digits.size() || !std::isfinite(value))
      refuse(text, fmt::format("\"{}\" is not a number", digits));
    return value;
  };
  Requirement requirement{text,           find_metric(match[1].str()), std::nullopt, match[2].str(),
                          match[4].str(), number(match[5].str())};
  if (match[6].length() > 0) {
    if (requirement.metric != nullptr && !requirement.metric->share) {
      refuse(text, fmt::format("{} is no share: a bound in % has no meaning", requirement.metric->id));
    }
    requirement.bound /= 100.0;
  }
  if (match[3].matched) requirement.threshold_m = number(match[3].str());
  if (requirement.metric == nullptr) {
    refuse(text, fmt::format("unknown metric \"{}\"{}", match[1].str(), did_you_mean(match[1].str(), metric_names())));
  }
  return requirement;
}

void require_computed(const Requirement& requirement, const MetricSelection& selection) {
  if (selection.contains(requirement.metric->id)) return;
  refuse(requirement.text, fmt::format("{} is not computed; add it to --metrics", requirement.metric->id));
}

/// Infinite decibels, of exact colors, are a value here.
RequirementOutcome check(const Requirement& requirement, const MetricRecords& metrics) {
  const Record* record = metrics.find(requirement.metric->id);
  if (record == nullptr) refuse(requirement.text, "the metric was not computed");
  const Record& part = part_of(*record, requirement);
  const std::string field = requirement.field.empty() ? "value" : requirement.field.substr(1);
  const std::optional<double> value = part.number(field);
  // A metric that has no value at all, for want of color, has no other field either.
  if (!value && !(part.value && std::isnan(*part.value))) {
    refuse(requirement.text, fmt::format("{} has no number {}", requirement.metric->id, field));
  }
  if (!value || std::isnan(*value)) return {false, std::nullopt};
  return {compare(*value, requirement.comparison, requirement.bound), *value};
}

}  // namespace

Requirement parse_requirement(const std::string& text, const EvaluationOptions& options) {
  Requirement requirement = parse(text);
  require_computed(requirement, select_metrics(options));
  check_threshold(requirement, options);
  return requirement;
}

Requirement parse_map_requirement(const std::string& text, const EvaluationOptions& options) {
  Requirement requirement = parse(text);
  if (requirement.metric->needs_reference) {
    refuse(text, fmt::format("{} needs a reference map, which is missing", requirement.metric->id));
  }
  require_computed(requirement, select_map_metrics(options));
  check_threshold(requirement, options);
  return requirement;
}

RequirementOutcome check(const Requirement& requirement, const Evaluation& evaluation) {
  return check(requirement, evaluation.metrics);
}

RequirementOutcome check(const Requirement& requirement, const MapEvaluation& evaluation) {
  return check(requirement, evaluation.metrics);
}

}  // namespace cmap
