#include <fmt/format.h>

#include <algorithm>

#include "cmap/report/table_text.hpp"
#include "leaderboard_tables.hpp"

namespace cmap {
namespace {

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

/// Nobody can test what was only printed.
void mark_published(const std::vector<TableCell*>& cells, std::string_view better, bool is_plain) {
  if (is_plain) {
    mark_best(cells, better);
  } else {
    mark_distinguishable(cells, better, [](std::size_t, std::size_t) { return RankVerdict::kNoBootstrap; });
  }
}

}  // namespace

std::optional<ScoreTable> published_table(const ScoreKind& kind, const PublishedScores& published, bool is_plain) {
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
  for (std::size_t column = 0; column < table.value_columns.size(); ++column)
    mark_published(cells_of(table, column), kind.better, is_plain);
  return table;
}

std::optional<ScoreTable> registration_table(const LeaderboardManifest& manifest, bool is_plain) {
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
    for (const auto& [sequence, cells] : by_sequence) mark_published(cells, "lower", is_plain);
  }
  return table;
}

}  // namespace cmap
