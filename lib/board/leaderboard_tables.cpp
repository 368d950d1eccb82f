#include "leaderboard_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cmap/eval/metric_catalog.hpp"
#include "cmap/report/file_names.hpp"
#include "cmap/report/table_text.hpp"
#include "score_notes.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

ScoreKind kind_of(const MetricInfo& info) {
  ScoreKind kind;
  kind.metric = info.id;
  kind.title = info.title;
  kind.symbol = info.symbol;
  kind.unit = info.unit;
  kind.better = info.better;
  kind.share = info.share;
  kind.headline = true;
  return kind;
}

ScoreKind at_threshold(ScoreKind kind, const std::string& at) {
  kind.at = at;
  kind.title += fmt::format(" <= {} m", at);
  return kind;
}

/// What the options ask for: tables stand there before any map is.
std::vector<Score> asked_for(const EvaluationOptions& options) {
  const MetricSelection selection = select_metrics(options);
  std::vector<Score> scores;
  for (const Metric* metric : metric_list()) {
    const MetricInfo& info = metric->info;
    if (!selection.contains(info.id) || info.id == "color_distance_by_range") continue;
    ScoreKind kind = kind_of(info);
    if (!info.per_threshold) {
      scores.push_back({kind, {}});
      continue;
    }
    for (const double& threshold_m : options.thresholds_m) {
      kind.headline = &threshold_m == &options.thresholds_m.front();
      scores.push_back({at_threshold(kind, fmt::format("{}", threshold_m)), {}});
    }
  }
  return scores;
}

/// What was published and nobody asked for.
std::vector<Score> published_scores(const LeaderboardManifest& manifest) {
  std::vector<Score> scores;
  if (!manifest.published) return scores;
  for (const PublishedScores::Metric& metric : manifest.published->metrics) {
    const MetricInfo& info = *find_metric(metric.id);
    const ScoreKind kind = kind_of(info);
    scores.push_back({info.per_threshold ? at_threshold(kind, kPublishedThreshold) : kind, {}});
  }
  return scores;
}

std::string scaled_digits(const ScoreKind& kind, double value) {
  const PaperScale scale = paper_scale(kind);
  return scale.unit == "%" ? hundredths(value) : digits(scale.factor * value);
}

TableCell cell_of(const LeaderboardPair& pair, const std::vector<Score>& scores, const ScoreKind& kind) {
  if (pair.state == PairState::kMissing)
    return {std::string(kNoValue), {}, Mark::kNone, "missing: " + with_file_names(pair.reason)};
  if (pair.state == PairState::kFailed)
    return {std::string(kFailedMark), {}, Mark::kNone, "failed: " + with_file_names(pair.reason)};
  const Score* score = score_of(scores, kind);
  const std::optional<double> value = value_of(scores, kind);
  if (!value) return {std::string(kNoValue), {}, Mark::kNone, note_on(score)};
  return {scaled_digits(kind, *value), value, Mark::kNone, note_on(score), band_of(score, paper_scale(kind).factor)};
}

/// Rows are methods, columns sequences; pairs and scores are in the runner's order, by sequence.
ScoreTable computed_table(const ScoreKind& kind, const LeaderboardManifest& manifest,
                          const std::vector<LeaderboardPair>& pairs, const std::vector<std::vector<Score>>& scores) {
  ScoreTable table{table_id(kind, "computed"), title_of(kind), {"method"}, {}, {}, {}};
  for (const LeaderboardSequence& sequence : manifest.sequences) table.value_columns.push_back(sequence.name);
  const std::size_t n_methods = manifest.methods.size();
  for (std::size_t m = 0; m < n_methods; ++m) {
    TableRow& row = table.rows.emplace_back(TableRow{{manifest.methods[m].name}, {}});
    for (std::size_t s = 0; s < manifest.sequences.size(); ++s) {
      row.cells.push_back(cell_of(pairs[s * n_methods + m], scores[s * n_methods + m], kind));
    }
  }
  return table;
}

/// The maps of each sequence, in the order of methods.
std::vector<Distinction> distinctions_of(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                                         const std::vector<std::vector<Score>>& scores) {
  const std::size_t n_methods = manifest.methods.size();
  std::vector<Distinction> distinctions;
  for (std::size_t s = 0; s < manifest.sequences.size(); ++s) {
    std::vector<const Json*> reports;
    std::vector<const std::vector<Score>*> of_maps;
    for (std::size_t i = s * n_methods; i < (s + 1) * n_methods; ++i) {
      reports.push_back(pairs[i].report.is_null() ? nullptr : &pairs[i].report);
      of_maps.push_back(&scores[i]);
    }
    distinctions.emplace_back(std::move(reports), std::move(of_maps));
  }
  return distinctions;
}

/// Marks the columns of a section by what is distinguishable.
void rank_columns(ScoreSection& section, std::vector<Distinction>& distinctions) {
  for (std::size_t column = 0; column < distinctions.size(); ++column) {
    section.rankings.add(mark_distinguishable(
        cells_of(section.computed, column), section.kind.better,
        [&](std::size_t a, std::size_t b) { return distinctions[column].verdict(section.kind, a, b); }));
  }
}

void mark_columns(ScoreTable& table, std::string_view better) {
  for (std::size_t column = 0; column < table.value_columns.size(); ++column)
    mark_best(cells_of(table, column), better);
}

std::vector<ScoreSection> sections_of(const std::vector<ScoreKind>& kinds, const LeaderboardManifest& manifest,
                                      const std::vector<LeaderboardPair>& pairs,
                                      const std::vector<std::vector<Score>>& scores, bool is_plain) {
  std::vector<ScoreSection> sections;
  for (const ScoreKind& kind : kinds) {
    ScoreSection& section =
        sections.emplace_back(ScoreSection{kind, computed_table(kind, manifest, pairs, scores), {}, {}});
    if (manifest.published) section.published = published_table(kind, *manifest.published, is_plain);
  }
  return sections;
}

}  // namespace

std::string title_of(const ScoreKind& kind) {
  const char* arrow = kind.better == "lower" ? " ↓" : kind.better == "higher" ? " ↑" : "";
  const std::string unit = paper_scale(kind).unit;
  return fmt::format("{}{}{}{}", kind.title, kind.symbol.empty() ? "" : fmt::format(" ({})", kind.symbol), arrow,
                     unit.empty() ? "" : fmt::format(" [{}]", unit));
}

std::string table_id(const ScoreKind& kind, const char* of) { return fmt::format("{}-{}", of, kind.id()); }

PaperScale paper_scale(const ScoreKind& kind) {
  if (kind.part == "skill") return {};
  const MetricInfo* info = find_metric(kind.metric);
  if (info != nullptr && !info->paper_unit.empty()) return {info->paper_factor, std::string(info->paper_unit)};
  return {1.0, kind.unit == "1" ? "" : kind.unit};
}

std::string heading_of(const ScoreKind& kind) {
  const MetricInfo* info = find_metric(kind.metric);
  const std::string title = info == nullptr ? kind.metric : std::string(info->title);
  return kind.symbol.empty() || kind.symbol == title ? title : fmt::format("{} ({})", title, kind.symbol);
}

LeaderboardScores leaderboard_scores(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                                     const LeaderboardLook& look) {
  LeaderboardScores scores;
  for (const LeaderboardPair& pair : pairs) {
    scores.scores.push_back(pair.report.is_null() ? std::vector<Score>{} : scores_of(pair.report));
  }
  std::vector<std::vector<Score>> all = scores.scores;
  all.insert(all.begin(), asked_for(manifest.options));
  all.push_back(published_scores(manifest));
  scores.sections = sections_of(kinds_of(all), manifest, pairs, scores.scores, look.plain_ranking);
  scores.registration = registration_table(manifest, look.plain_ranking);
  std::vector<Distinction> distinctions = distinctions_of(manifest, pairs, scores.scores);
  for (ScoreSection& section : scores.sections) {
    if (look.plain_ranking) {
      mark_columns(section.computed, section.kind.better);
    } else {
      rank_columns(section, distinctions);
    }
  }
  for (const Distinction& distinction : distinctions) scores.evidence.add(distinction.evidence());
  for (ScoreSection& section : scores.sections) {
    const std::string note = section.rankings.text(scores.evidence.how());
    if (!note.empty()) section.computed.notes = {note};
  }
  return scores;
}

std::vector<std::string> leaderboard_notes(const LeaderboardManifest& manifest,
                                           const std::vector<LeaderboardPair>& pairs, const LeaderboardScores& scores) {
  RankingCounts rankings;
  std::vector<ScoreKind> kinds;
  for (const ScoreSection& section : scores.sections) {
    rankings.add(section.rankings);
    kinds.push_back(section.kind);
  }
  std::vector<std::string> notes = ranking_notes(rankings, scores.evidence), names;
  for (const LeaderboardPair& pair : pairs) names.push_back(fmt::format("{} / {}", pair.sequence, pair.method));
  for (std::string& note : missing_notes(names, scores.scores, kinds)) notes.push_back(std::move(note));
  for (const LeaderboardPair& pair : pairs) {
    if (pair.state == PairState::kDone) continue;
    notes.push_back(fmt::format("{} {} / {}: {}", pair.state == PairState::kFailed ? kFailedMark : kNoValue,
                                pair.sequence, pair.method, with_file_names(pair.reason)));
  }
  if (!manifest.published) return notes;
  const PublishedScores& published = *manifest.published;
  notes.push_back(fmt::format("published: {}", published.source));
  if (!published.color_scale.empty()) {
    std::vector<std::string> scales;
    for (const auto& [sequence, scale] : published.color_scale) scales.push_back(fmt::format("{} {}", sequence, scale));
    notes.push_back(fmt::format(
        "published color distances stand on different scales and do not compare between sequences; CF = -20 log10(CD / "
        "scale) tells the scale: {}; columns \"of 255\" are CD / scale x 255",
        fmt::join(scales, ", ")));
  }
  notes.insert(notes.end(), published.notes.begin(), published.notes.end());
  return notes;
}

}  // namespace cmap
