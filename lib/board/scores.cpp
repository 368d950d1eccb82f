#include "scores.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/eval/metric_catalog.hpp"
#include "cmap/report/table_text.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

std::optional<double> number(const Json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

ScoreKind kind_of(const std::string& id, const Json& record) {
  const MetricInfo* info = find_metric(id);
  ScoreKind kind;
  kind.metric = id;
  kind.title = info == nullptr ? id : std::string(info->title);  // a later version may know more metrics
  kind.symbol = record.at("symbol").get<std::string>();
  kind.unit = record.at("unit").get<std::string>();
  if (record.at("better").is_string()) kind.better = record.at("better").get<std::string>();
  kind.share = info != nullptr && info->share;
  return kind;
}

/// The value of a level, where the record has that level.
std::optional<double> level(const Json& record, const char* name) {
  return record.contains(name) ? number(record.at(name).at("value")) : std::nullopt;
}

std::optional<Phases> phases_of(const Json& record) {
  if (!record.contains("phases")) return std::nullopt;
  const Json& json = record.at("phases");
  const auto std = number(json.at("std")), min = number(json.at("min")), max = number(json.at("max"));
  Phases phases;
  for (const Json& value : json.at("values")) phases.values.push_back(number(value));
  const auto n = std::ranges::count_if(phases.values, [](const auto& value) { return value.has_value(); });
  constexpr std::ptrdiff_t kLeast = 2;  // of one there is no spread
  if (n < kLeast || !std || !min || !max) return std::nullopt;
  phases.std = *std;
  phases.min = *min;
  phases.max = *max;
  return phases;
}

/// A score's skill is one of its own: higher is better whatever the metric's direction.
Score skill_of(ScoreKind kind, const Json& skill) {
  kind.part = "skill";
  kind.title = fmt::format("skill of {}", kind.title);
  kind.symbol.clear();
  kind.unit = "1";
  kind.better = "higher";
  kind.share = false;
  return {kind, number(skill.at("value")), {}, {}, {}, skill.value("reason", "")};
}

Score coverage_of(ScoreKind kind, const Json& coverage) {
  kind.part = "coverage";
  kind.title = "coverage (recall of any color)";
  kind.symbol.clear();
  return {kind, number(coverage)};
}

void add_per_threshold(std::vector<Score>& scores, const ScoreKind& metric, const Json& entries) {
  for (const Json& entry : entries) {
    ScoreKind kind = metric;
    kind.at = fmt::format("{}", entry.at("threshold_m").get<double>());
    kind.title += fmt::format(" <= {} m", kind.at);
    kind.headline = &entry == &entries.front();
    scores.push_back({kind, number(entry.at("value")), level(entry, "floor")});
  }
}

void add_per_range(std::vector<Score>& scores, const ScoreKind& metric, const Json& bins) {
  for (const Json& bin : bins) {
    ScoreKind kind = metric;
    const double lo = bin.at("lo_m").get<double>(), hi = bin.at("hi_m").get<double>();
    kind.at = fmt::format("{}-{}", lo, hi);
    kind.title = fmt::format("color distance at {} to {} m", lo, hi);
    scores.push_back({kind, number(bin.at("value"))});
  }
}

bool is_same(const ScoreKind& a, const ScoreKind& b) {
  return a.metric == b.metric && a.part == b.part && a.at == b.at;
}

std::size_t place_in_reports(const ScoreKind& kind) {
  const auto place = std::ranges::find(metric_list(), kind.metric, [](const Metric* m) { return m->info.id; });
  return static_cast<std::size_t>(place - metric_list().begin());
}

}  // namespace

std::string ScoreKind::id() const { return metric + (part.empty() ? "" : "." + part) + (at.empty() ? "" : "@" + at); }

std::vector<Score> scores_of(const Json& report) {
  std::vector<Score> scores;
  for (const auto& [id, record] : report.at("metrics").items()) {
    ScoreKind kind = kind_of(id, record);
    if (record.contains("per_threshold")) {
      add_per_threshold(scores, kind, record.at("per_threshold"));
    } else if (record.contains("per_range")) {
      add_per_range(scores, kind, record.at("per_range"));
    } else {
      kind.headline = true;
      scores.push_back({kind, is_infinite(report, id) ? INFINITY : number(record.at("value")), level(record, "floor"),
                        level(record, "chance"), phases_of(record)});
    }
    if (record.contains("skill")) scores.push_back(skill_of(kind, record.at("skill")));
    if (record.contains("coverage")) scores.push_back(coverage_of(kind, record.at("coverage")));
  }
  return scores;
}

std::vector<ScoreKind> kinds_of(const std::vector<std::vector<Score>>& reports) {
  std::vector<ScoreKind> kinds;
  for (const auto& scores : reports) {
    for (const Score& score : scores) {
      const auto same = [&](const ScoreKind& kind) { return is_same(kind, score.kind); };
      if (std::ranges::none_of(kinds, same)) kinds.push_back(score.kind);
    }
  }
  std::ranges::stable_sort(kinds, {}, place_in_reports);
  return kinds;
}

const Score* score_of(const std::vector<Score>& scores, const ScoreKind& kind) {
  const auto score = std::ranges::find_if(scores, [&](const Score& s) { return is_same(s.kind, kind); });
  return score == scores.end() ? nullptr : &*score;
}

std::optional<double> value_of(const std::vector<Score>& scores, const ScoreKind& kind) {
  const Score* score = score_of(scores, kind);
  return score == nullptr ? std::nullopt : score->value;
}

}  // namespace cmap
