#include <fmt/format.h>

#include "cmap/eval/metric_catalog.hpp"
#include "leaderboard_tables.hpp"

namespace cmap {
namespace {

const char* state_name(const LeaderboardPair& pair, const std::optional<double>& value) {
  switch (pair.state) {
    case PairState::kMissing:
      return "missing";
    case PairState::kFailed:
      return "failed";
    case PairState::kDone:
      break;
  }
  return value ? "done" : "no value";
}

const char* rank_name(Mark mark) {
  return mark == Mark::kBest           ? "best"
         : mark == Mark::kSecond       ? "second"
         : mark == Mark::kBestUntested ? "best untested"
                                       : "";
}

/// Floor, chance, and the spread over the grid's phases.
std::string level_fields(const Score* score) {
  if (score == nullptr) return ",,";
  const auto std = score->phases ? std::optional(score->phases->std) : std::nullopt;
  return fmt::format("{},{},{}", csv_number(score->floor), csv_number(score->chance), csv_number(std));
}

std::string computed_lines(const ScoreSection& section, const std::vector<LeaderboardPair>& pairs,
                           const std::vector<std::vector<Score>>& scores, std::size_t n_methods) {
  const ScoreKind& kind = section.kind;
  std::string text;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const TableCell& cell = section.computed.rows[i % n_methods].cells[i / n_methods];
    text += fmt::format("{},{},{},{},{},{},{},computed,{},{},{},{}\n", kind.metric, kind.part, csv_digits(kind.at),
                        csv_field(kind.unit), kind.better, csv_field(pairs[i].sequence), csv_field(pairs[i].method),
                        state_name(pairs[i], cell.value), csv_number(cell.value), rank_name(cell.mark),
                        level_fields(score_of(scores[i], kind)));
  }
  return text;
}

/// As in the manifest, and color distances also of 255.
std::string published_lines(const PublishedScores& published) {
  std::string text;
  for (const PublishedScores::Metric& metric : published.metrics) {
    const MetricInfo& info = *find_metric(metric.id);
    const bool is_distance = metric.id == "color_distance", is_scatter = metric.id == "color_consistency";
    const std::string unit = is_distance ? "as printed" : std::string(info.unit) + (is_scatter ? " x 100" : "");
    const auto line = [&](const PublishedScores::Entry& entry, const std::string& in, const char* source,
                          const std::optional<double>& value) {
      text += fmt::format("{},,{},{},{},{},{},{},{},{},,,,\n", metric.id, info.per_threshold ? kPublishedThreshold : "",
                          in, info.better, csv_field(entry.sequence), csv_field(entry.method), source,
                          value ? "done" : "failed", csv_number(value));
    };
    for (const PublishedScores::Entry& entry : metric.entries) {
      line(entry, unit, "published", entry.value);
      const auto scale = published.color_scale.find(entry.sequence);
      if (!is_distance || scale == published.color_scale.end() || !entry.value) continue;
      line(entry, "of 255", "normalized", *entry.value * 255.0 / scale->second);
    }
  }
  return text;
}

}  // namespace

std::string leaderboard_csv(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                            const LeaderboardScores& scores) {
  std::string text = "metric,part,at_m,unit,better,sequence,method,source,state,value,rank,floor,chance,phase_std\n";
  for (const ScoreSection& section : scores.sections) {
    text += computed_lines(section, pairs, scores.scores, manifest.methods.size());
  }
  return manifest.published ? text + published_lines(*manifest.published) : text;
}

}  // namespace cmap
