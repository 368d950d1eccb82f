#include "cmap/board/comparison.hpp"

#include <fmt/format.h>

#include "cmap/io/file_place.hpp"
#include "cmap/report/file_names.hpp"
#include "cmap/report/table_text.hpp"
#include "comparison_csv.hpp"
#include "comparison_scores.hpp"
#include "distinguishable.hpp"
#include "gain_intervals.hpp"
#include "gains.hpp"
#include "html_tables.hpp"
#include "score_notes.hpp"
#include "score_table.hpp"
#include "version_notes.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

TableCell cell_for(const ScoreKind& kind, const std::vector<Score>& scores) {
  const std::optional<double> value = value_of(scores, kind);
  const Score* score = score_of(scores, kind);
  return {shown_value(kind, value), value, Mark::kNone, note_on(score), band_of(score)};
}

Distinction distinction_of(const std::vector<SavedReport>& reports, const ComparisonScores& comparison) {
  std::vector<const Json*> json;
  std::vector<const std::vector<Score>*> scores;
  for (const SavedReport& report : reports) json.push_back(&report.json);
  for (const std::vector<Score>& of_report : comparison.scores) scores.push_back(&of_report);
  return Distinction(std::move(json), std::move(scores));
}

/// Marks a row by what is distinguishable.
std::optional<RankVerdict> rank(TableRow& row, const ScoreKind& kind, Distinction& distinction) {
  return mark_distinguishable(cells_of(row), kind.better,
                              [&](std::size_t a, std::size_t b) { return distinction.verdict(kind, a, b); });
}

struct RankedScores {
  ScoreTable table;
  std::vector<std::optional<RankVerdict>> rankings;  ///< by row
};

RankedScores ranked_scores(const ComparisonScores& comparison, Distinction& distinction, bool is_plain) {
  RankedScores ranked{{"scores", "", kMetricHeads, comparison.names, {}, {}}, {}};
  for (const ScoreKind& kind : comparison.kinds) {
    TableRow& row = ranked.table.rows.emplace_back(metric_row(kind));
    for (const auto& scores : comparison.scores) row.cells.push_back(cell_for(kind, scores));
    if (is_plain) {
      mark_best(cells_of(row), kind.better);
    } else {
      ranked.rankings.push_back(rank(row, kind, distinction));
    }
  }
  return ranked;
}

/// Pages and CSV are not typeset.
std::optional<TableFormat> table_format(ComparisonFormat format) {
  switch (format) {
    case ComparisonFormat::kText:
      return TableFormat::kText;
    case ComparisonFormat::kMarkdown:
      return TableFormat::kMarkdown;
    case ComparisonFormat::kLatex:
      return TableFormat::kLatex;
    case ComparisonFormat::kCsv:
    case ComparisonFormat::kHtml:
      break;
  }
  return std::nullopt;
}

/// How much the rankings say, and what scores are missing.
std::vector<std::string> notes_on_scores(const ComparisonScores& comparison, const RankedScores& ranked,
                                         const Evidence& evidence) {
  RankingCounts counts;
  for (const std::optional<RankVerdict>& ranking : ranked.rankings) counts.add(ranking);
  std::vector<std::string> notes = ranking_notes(counts, evidence);
  for (std::string& note : missing_notes(comparison.names, comparison.scores, comparison.kinds))
    notes.push_back(std::move(note));
  return notes;
}

std::vector<std::string> notes_on_reports(const std::vector<SavedReport>& reports, const ComparisonOptions& options) {
  std::vector<std::string> notes;
  const Json& inputs = reports.front().json.at("inputs");
  if (inputs.contains("reference")) {
    const Json& reference = inputs.at("reference");
    notes.push_back(fmt::format(
        "reference {}: {} points, SHA-256 {}", file_name(reference.at("path").get<std::string>()),
        with_thousands(reference.at("finite_points")), reference.at("sha256").get<std::string>().substr(0, 12)));
    if (auto alignments = difference(reports, Json::json_pointer("/alignment/method"))) {
      notes.push_back(fmt::format("alignment: {}", *alignments));
    }
  }
  for (std::string& note : version_notes(reports, options)) notes.push_back(std::move(note));
  return notes;
}

std::string html(const std::vector<ScoreTable>& tables, bool is_plain) {
  HtmlPage page("Comparison of maps");
  page.add_key("of each row; - no value. The tables sort by their headings.", is_plain);
  for (const ScoreTable& table : tables) page.add_table(table);
  return page.finish();
}

}  // namespace

std::string format_comparison(const std::vector<SavedReport>& reports, const ComparisonOptions& options,
                              ComparisonFormat format) {
  const ComparisonScores comparison = scores_to_compare(reports, options);
  Distinction distinction = distinction_of(reports, comparison);
  const RankedScores ranked = ranked_scores(comparison, distinction, options.plain_ranking);
  if (format == ComparisonFormat::kCsv) return comparison_csv(comparison, options.baseline, ranked.rankings);
  std::vector<ScoreTable> tables{ranked.table};
  if (options.baseline && reports.size() > 1) {
    tables.push_back(gain_table(comparison, *options.baseline));
    auto intervals = gain_interval_table(distinction.bootstrap(), comparison, *options.baseline);
    if (intervals) tables.push_back(std::move(*intervals));
  }
  const std::optional<TableFormat> typeset_as = table_format(format);
  std::vector<std::string>& notes = tables.front().notes;
  if (typeset_as) notes.push_back(marks_note(*typeset_as, options.plain_ranking) + "; " + missing_note(*typeset_as));
  for (const auto& more :
       {notes_on_scores(comparison, ranked, distinction.evidence()), notes_on_reports(reports, options)})
    notes.insert(notes.end(), more.begin(), more.end());
  if (!typeset_as) return html(tables, options.plain_ranking);
  if (format == ComparisonFormat::kLatex && !options.bands) remove_bands(tables);
  return typeset(tables, *typeset_as);
}

}  // namespace cmap
