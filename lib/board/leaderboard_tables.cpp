#include "leaderboard_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cmap/eval/metric_catalog.hpp"
#include "cmap/report/file_names.hpp"
#include "cmap/report/table_text.hpp"

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

std::string title_of(const ScoreKind& kind) {
  const char* arrow = kind.better == "lower" ? " ↓" : kind.better == "higher" ? " ↑" : "";
  const std::string unit = paper_scale(kind).unit;
  return fmt::format("{}{}{}{}", kind.title, kind.symbol.empty() ? "" : fmt::format(" ({})", kind.symbol), arrow,
                     unit.empty() ? "" : fmt::format(" [{}]", unit));
}

std::string table_id(const ScoreKind& kind, const char* of) { return fmt::format("{}-{}", of, kind.id()); }

TableCell cell_of(const LeaderboardPair& pair, const std::vector<Score>& scores, const ScoreKind& kind) {
  if (pair.state == PairState::kMissing)
    return {std::string(kNoValue), {}, Mark::kNone, "missing: " + with_file_names(pair.reason)};
  if (pair.state == PairState::kFailed)
    return {std::string(kFailedMark), {}, Mark::kNone, "failed: " + with_file_names(pair.reason)};
  const std::optional<double> value = value_of(scores, kind);
  if (!value) return {std::string(kNoValue), {}, Mark::kNone, "no value"};
  return {scaled_digits(kind, *value), value, Mark::kNone, fmt::format("{}", *value)};
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
  mark_columns(table, kind.better);
  return table;
}

/// Names in the order in which they come up.
template <class Name>
std::vector<std::string> names_in(const std::vector<PublishedScores::Entry>& entries, Name&& name) {
  std::vector<std::string> names;
  for (const auto& entry : entries) {
    if (std::ranges::count(names, entry.*name) == 0) names.push_back(entry.*name);
  }
  return names;
}

/// As printed, in the unit of our tables: six digits are more than any paper prints.
std::string published_text(const ScoreKind& kind, double value) {
  const PaperScale scale = paper_scale(kind);
  return fmt::format("{:.6g}", scale.unit == "%" ? 100.0 * value : value);
}

/// The cells of one published value: itself and, for color distance, what it is of 255.
void add_published(TableRow& row, const ScoreKind& kind, const PublishedScores::Entry* entry,
                   const std::optional<double>& color_scale) {
  const auto add = [&](auto&& text, double factor) {
    if (entry == nullptr) {
      row.cells.push_back({std::string(kNoValue), {}, Mark::kNone, "not published"});
    } else if (!entry->value) {
      row.cells.push_back({std::string(kFailedMark), {}, Mark::kNone, "failed, as published"});
    } else {
      const double value = factor * *entry->value;
      row.cells.push_back({text(value), value, Mark::kNone, fmt::format("published {}", *entry->value)});
    }
  };
  add([&](double value) { return published_text(kind, value); }, 1.0);
  if (color_scale) add([](double value) { return digits(value); }, 255.0 / *color_scale);
}

std::optional<ScoreTable> published_table(const ScoreKind& kind, const PublishedScores& published) {
  if (!kind.part.empty() || (!kind.at.empty() && kind.at != kPublishedThreshold)) return std::nullopt;
  const auto metric = std::ranges::find(published.metrics, kind.metric, &PublishedScores::Metric::id);
  if (metric == published.metrics.end()) return std::nullopt;
  ScoreTable table{table_id(kind, "published"), title_of(kind) + ", published", {"method"}, {}, {}, {}};
  const auto sequences = names_in(metric->entries, &PublishedScores::Entry::sequence);
  const auto scale_of = [&](const std::string& sequence) -> std::optional<double> {
    const auto scale = published.color_scale.find(sequence);
    return kind.metric == "color_distance" && scale != published.color_scale.end() ? std::optional(scale->second)
                                                                                   : std::nullopt;
  };
  if (kind.metric == "color_distance") table.title = "color distance (CD) ↓, published";
  for (const std::string& sequence : sequences) {
    table.value_columns.push_back(sequence);
    if (scale_of(sequence)) table.value_columns.push_back("of 255");
  }
  for (const std::string& method : names_in(metric->entries, &PublishedScores::Entry::method)) {
    TableRow& row = table.rows.emplace_back(TableRow{{method}, {}});
    for (const std::string& sequence : sequences) {
      const auto entry = std::ranges::find_if(
          metric->entries, [&](const auto& e) { return e.sequence == sequence && e.method == method; });
      add_published(row, kind, entry == metric->entries.end() ? nullptr : &*entry, scale_of(sequence));
    }
  }
  mark_columns(table, kind.better);
  return table;
}

}  // namespace

PaperScale paper_scale(const ScoreKind& kind) {
  const MetricInfo* info = find_metric(kind.metric);
  if (info != nullptr && !info->paper_unit.empty()) return {info->paper_factor, std::string(info->paper_unit)};
  return {1.0, kind.unit == "1" ? "" : kind.unit};
}

std::string heading_of(const ScoreKind& kind) {
  const MetricInfo* info = find_metric(kind.metric);
  const std::string title = info == nullptr ? kind.metric : std::string(info->title);
  return kind.symbol.empty() || kind.symbol == title ? title : fmt::format("{} ({})", title, kind.symbol);
}

std::vector<ScoreSection> leaderboard_sections(const LeaderboardManifest& manifest,
                                               const std::vector<LeaderboardPair>& pairs) {
  std::vector<std::vector<Score>> scores;
  for (const LeaderboardPair& pair : pairs) {
    scores.push_back(pair.report.is_null() ? std::vector<Score>{} : scores_of(pair.report));
  }
  std::vector<std::vector<Score>> all = scores;
  all.insert(all.begin(), asked_for(manifest.options));
  all.push_back(published_scores(manifest));
  std::vector<ScoreSection> sections;
  for (const ScoreKind& kind : kinds_of(all)) {
    sections.push_back({kind, computed_table(kind, manifest, pairs, scores), {}});
    if (manifest.published) sections.back().published = published_table(kind, *manifest.published);
  }
  return sections;
}

std::optional<ScoreTable> registration_table(const LeaderboardManifest& manifest) {
  if (!manifest.published || manifest.published->registration.empty()) return std::nullopt;
  const std::vector<std::pair<const char*, const char*>> columns{
      {"rmse", "RMSE [m]"}, {"average_wasserstein", "AWD [m]"}, {"chamfer", "CD# [m]"}, {"spatial_consistency", "SCS"}};
  ScoreTable table{
      "published-registration", "registration, published: lower is better", {"sequence", "variant"}, {}, {}, {}};
  for (const auto& [id, heading] : columns) table.value_columns.emplace_back(heading);
  for (const PublishedScores::Registration& entry : manifest.published->registration) {
    TableRow& row = table.rows.emplace_back(TableRow{{entry.sequence, entry.variant}, {}});
    for (const auto& [id, heading] : columns) {
      const auto value = entry.values.find(id);
      const bool is_there = value != entry.values.end() && value->second;
      row.cells.push_back(is_there ? TableCell{fmt::format("{:.6g}", *value->second), value->second, Mark::kNone, ""}
                                   : TableCell{std::string(kNoValue), {}, Mark::kNone, "not published"});
    }
  }
  // The variants of one sequence compare with each other.
  for (std::size_t column = 0; column < columns.size(); ++column) {
    std::map<std::string, std::vector<TableCell*>> by_sequence;
    for (TableRow& row : table.rows) by_sequence[row.heads.front()].push_back(&row.cells[column]);
    for (const auto& [sequence, cells] : by_sequence) mark_best(cells, "lower");
  }
  return table;
}

std::vector<std::string> leaderboard_notes(const LeaderboardManifest& manifest,
                                           const std::vector<LeaderboardPair>& pairs) {
  std::vector<std::string> notes;
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
