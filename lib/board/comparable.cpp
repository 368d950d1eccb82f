#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "cmap/board/comparison.hpp"
#include "cmap/core/error.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "earlier_reports.hpp"
#include "parameter_scope.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;
using Ids = std::set<std::string>;

/// Options, by name, that choose what is computed beside the values.
Ids names_of_choices() {
  EvaluationOptions options;
  Ids names;
  for (const OptionField& field : option_fields(options)) {
    if (field.role == OptionRole::kBeside) names.insert(field.name);
  }
  return names;
}

/// Objects read the same whatever the order of their members.
std::string shown(const Json& object, const std::string& key) {
  return object.contains(key) ? nlohmann::json(object.at(key)).dump() : "missing";
}

/// "lcr-tau is 0.1 and 0.2" for each key of either that differs.
template <class Skip>
std::vector<std::string> differences(const Json& a, const Json& b, Skip&& skip) {
  std::vector<std::string> list;
  const auto compare = [&](const std::string& key) {
    if (!skip(key) && shown(a, key) != shown(b, key)) {
      list.push_back(fmt::format("{} is {} and {}", key, shown(a, key), shown(b, key)));
    }
  };
  for (const auto& [key, value] : a.items()) compare(key);
  for (const auto& [key, value] : b.items()) {
    if (!a.contains(key)) compare(key);
  }
  return list;
}

/// Where two reports do not compare because they come from different versions, the way out.
std::string said_of_versions(const SavedReport& a, const SavedReport& b) {
  const auto version = [](const SavedReport& report) {
    return report.json.at("tool").at("version").get<std::string>();
  };
  if (version(a) == version(b)) return "";
  return fmt::format(
      "; they come from versions {} and {} of cmap (see CHANGELOG.md): evaluate both maps with one of them, or leave "
      "the metric out with --metrics",
      version(a), version(b));
}

/// The chosen metrics that both have: only what bears on them must be the same.
Ids metrics_to_compare(const SavedReport& a, const SavedReport& b, const MetricSelection* chosen) {
  Ids ids;
  for (const auto& [id, record] : a.json.at("metrics").items()) {
    if (b.json.at("metrics").contains(id) && (chosen == nullptr || chosen->contains(id))) ids.insert(id);
  }
  return ids;
}

void require_same_parameters(const SavedReport& a, const SavedReport& b, const Ids& metrics) {
  const Ids choices = names_of_choices();
  const auto skip = [&](const std::string& name) { return choices.contains(name) || !bears_on(name, metrics); };
  const auto list = differences(a.json.at("parameters"), b.json.at("parameters"), skip);
  if (list.empty()) return;
  throw UsageError(fmt::format("{} and {} have different parameters: {}; evaluate both maps with the same ones{}",
                               a.path, b.path, fmt::join(list, "; "), said_of_versions(a, b)));
}

/// Thresholds or bins of a record, without their values.
Json levels_of(const Json& record) {
  Json levels = Json::array();
  for (const char* list : {"per_threshold", "per_range"}) {
    if (!record.contains(list)) continue;
    for (const Json& entry : record.at(list)) {
      for (const char* key : {"threshold_m", "lo_m", "hi_m"}) {
        if (entry.contains(key)) levels.push_back(entry.at(key));
      }
    }
  }
  return levels;
}

/// What the definition of a metric shows in its record.
Json definition_of(const Json& record) {
  return {{"unit", record.at("unit")},
          {"better", record.at("better")},
          {"symbol", record.at("symbol")},
          {"levels", levels_of(record)},
          // A color metric of a map without color has no parameters.
          {"parameters", record.at("parameters")}};
}

/// Color metrics of maps without color have neither parameters nor levels.
bool lacks_color(const Json& record) {
  return record.contains("value") && record.at("value").is_null() && record.at("parameters").empty();
}

void require_same_definition(const SavedReport& a, const SavedReport& b, const std::string& id) {
  const Json &of_a = a.json.at("metrics").at(id), &of_b = b.json.at("metrics").at(id);
  const bool without_color = lacks_color(of_a) || lacks_color(of_b);
  const auto skip = [&](const std::string& key) { return without_color && (key == "parameters" || key == "levels"); };
  auto list = differences(definition_of(of_a), definition_of(of_b), skip);
  for (const DefinitionChange& change : definition_changes()) {
    const bool is_between = is_before(a.json, change) != is_before(b.json, change);
    if (is_between && change.metric == id && !change.mixes) list.push_back(fmt::format("before, {}", change.what));
  }
  if (list.empty()) return;
  throw UsageError(fmt::format("{} and {} define {} differently: {}{}", a.path, b.path, id, fmt::join(list, "; "),
                               said_of_versions(a, b)));
}

/// Reports of one map each have none.
void require_same_reference(const SavedReport& a, const SavedReport& b) {
  const auto is_of_pair = [](const SavedReport& report) { return report.json.at("inputs").contains("reference"); };
  if (!is_of_pair(a) && !is_of_pair(b)) return;
  if (!is_of_pair(a) || !is_of_pair(b)) {
    const bool a_is = is_of_pair(a);
    throw UsageError(fmt::format("{} is about a map and its reference and {} about a map alone: they do not compare",
                                 (a_is ? a : b).path, (a_is ? b : a).path));
  }
  const auto reference = [](const SavedReport& report) { return report.json.at("inputs").at("reference"); };
  const auto hash = [&](const SavedReport& report) { return reference(report).at("sha256").get<std::string>(); };
  if (hash(a) == hash(b)) return;
  const auto described = [&](const SavedReport& report) {
    return fmt::format("{} (SHA-256 {}...)", reference(report).at("path").get<std::string>(),
                       hash(report).substr(0, 12));
  };
  throw UsageError(
      fmt::format("{} and {} have different references: {} and {}; scores against different maps do not compare: give "
                  "the reports of one sequence at a time, or use cmap_leaderboard for several",
                  a.path, b.path, described(a), described(b)));
}

}  // namespace

void require_comparable(const std::vector<SavedReport>& reports, const ComparisonOptions& options) {
  EvaluationOptions wanted;
  wanted.metrics = options.metrics;
  const MetricSelection chosen = select_metrics(wanted);
  for (std::size_t i = 1; i < reports.size(); ++i) {
    require_same_reference(reports.front(), reports[i]);
    for (std::size_t k = 0; k < i; ++k) {
      const Ids metrics = metrics_to_compare(reports[k], reports[i], options.metrics.empty() ? nullptr : &chosen);
      require_same_parameters(reports[k], reports[i], metrics);
      for (const std::string& id : metrics) require_same_definition(reports[k], reports[i], id);
    }
  }
}

}  // namespace cmap
