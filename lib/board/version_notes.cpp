#include "version_notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "comparison_scores.hpp"
#include "earlier_reports.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

bool is_compared(const ComparisonScores& comparison, std::string_view metric) {
  return std::ranges::count(comparison.kinds, metric, &ScoreKind::metric) > 0;
}

/// The metrics whose values from before and since a change stand side by side, by what was different before.
std::map<std::string_view, std::vector<std::string_view>> mixed_metrics(const std::vector<SavedReport>& reports,
                                                                        const ComparisonScores& comparison) {
  std::map<std::string_view, std::vector<std::string_view>> metrics;
  for (const DefinitionChange& change : definition_changes()) {
    const auto n_before = std::ranges::count_if(reports, [&](const auto& r) { return is_before(r.json, change); });
    const bool is_mixed = n_before > 0 && static_cast<std::size_t>(n_before) < reports.size();
    if (is_mixed && change.mixes && is_compared(comparison, change.metric))
      metrics[change.what].push_back(change.metric);
  }
  return metrics;
}

}  // namespace

std::optional<std::string> difference(const std::vector<SavedReport>& reports, const Json::json_pointer& place) {
  std::map<std::string, std::vector<std::string>> groups;
  for (const SavedReport& report : reports) groups[report.json.at(place).get<std::string>()].push_back(report.name);
  if (groups.size() < 2) return std::nullopt;
  std::vector<std::string> parts;
  for (const auto& [value, names] : groups) parts.push_back(fmt::format("{} for {}", value, fmt::join(names, ", ")));
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::vector<std::string> version_notes(const std::vector<SavedReport>& reports, const ComparisonOptions& options) {
  std::vector<std::string> notes;
  const auto versions = difference(reports, Json::json_pointer("/tool/version"));
  if (!versions) return notes;
  notes.push_back(fmt::format("version of cmap: {}; what changed between them is in CHANGELOG.md", *versions));
  for (const auto& [what, metrics] : mixed_metrics(reports, scores_to_compare(reports, options))) {
    notes.push_back(fmt::format("in the earlier version {}: {}", what, fmt::join(metrics, ", ")));
  }
  return notes;
}

}  // namespace cmap
