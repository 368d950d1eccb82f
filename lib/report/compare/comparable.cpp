#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "cmap/core/error.hpp"
#include "cmap/report/comparison.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// What was chosen to be computed beside the values; it changes none.
bool is_choice(const std::string& parameter) {
  static const std::set<std::string> kChoices{"metrics",
                                              "as",
                                              "lcr-curve",
                                              "bootstrap",
                                              "block",
                                              "observed",
                                              "observed-range",
                                              "observed-voxel",
                                              "sensitivity",
                                              "sensitivity-translation",
                                              "sensitivity-rotation"};
  return kChoices.contains(parameter);
}

std::string shown(const Json& object, const std::string& key) {
  return object.contains(key) ? object.at(key).dump() : "missing";
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

void require_same_parameters(const SavedReport& a, const SavedReport& b) {
  const auto list = differences(a.json.at("parameters"), b.json.at("parameters"), is_choice);
  if (list.empty()) return;
  throw UsageError(fmt::format("{} and {} have different parameters: {}; evaluate both maps with the same ones", a.path,
                               b.path, fmt::join(list, "; ")));
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

void require_same_definitions(const SavedReport& a, const SavedReport& b) {
  for (const auto& [id, record] : a.json.at("metrics").items()) {
    if (!b.json.at("metrics").contains(id)) continue;
    const Json &other = b.json.at("metrics").at(id), *records[] = {&record, &other};
    const bool lacks_color = std::ranges::any_of(records, [](const Json* r) {
      return r->contains("value") && r->at("value").is_null() && r->at("parameters").empty();
    });
    const auto skip = [&](const std::string& key) { return lacks_color && (key == "parameters" || key == "levels"); };
    const auto list = differences(definition_of(record), definition_of(other), skip);
    if (list.empty()) continue;
    throw UsageError(fmt::format("{} and {} define {} differently: {}", a.path, b.path, id, fmt::join(list, "; ")));
  }
}

void require_same_reference(const SavedReport& a, const SavedReport& b) {
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

void require_comparable(const std::vector<SavedReport>& reports) {
  for (std::size_t i = 1; i < reports.size(); ++i) {
    require_same_reference(reports.front(), reports[i]);
    require_same_parameters(reports.front(), reports[i]);
    for (std::size_t k = 0; k < i; ++k) require_same_definitions(reports[k], reports[i]);
  }
}

}  // namespace cmap
