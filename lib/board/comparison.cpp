#include "cmap/board/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/io/file_place.hpp"
#include "cmap/report/file_names.hpp"
#include "cmap/report/table_text.hpp"
#include "comparison_scores.hpp"
#include "gain_intervals.hpp"
#include "html_tables.hpp"
#include "score_table.hpp"
#include "version_notes.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

TableRow row_heads(const ScoreKind& kind) { return {{kind.title, kind.symbol, arrow(kind), shown_unit(kind)}, {}}; }

const std::vector<std::string> kHeads{"metric", "symbol", "", "unit"};

std::string all_digits(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : "no value"; }

ScoreTable score_table(const ComparisonScores& comparison) {
  ScoreTable table{"scores", "", kHeads, comparison.names, {}, {}};
  for (const ScoreKind& kind : comparison.kinds) {
    TableRow& row = table.rows.emplace_back(row_heads(kind));
    for (const auto& scores : comparison.scores) {
      const std::optional<double> value = value_of(scores, kind);
      row.cells.push_back({shown_value(kind, value), value, Mark::kNone, all_digits(value)});
    }
    std::vector<TableCell*> cells;
    for (TableCell& cell : row.cells) cells.push_back(&cell);
    mark_best(cells, kind.better);
  }
  return table;
}

/// By how much `value` is better than `base`, in the metric's unit: negative where it is worse.
std::optional<double> gain(const ScoreKind& kind, const std::optional<double>& value,
                           const std::optional<double>& base) {
  if (!value || !base || kind.better.empty()) return std::nullopt;
  if (*value == *base) return 0.0;  // both infinite, too
  return kind.better == "lower" ? *base - *value : *value - *base;
}

std::optional<double> relative(const std::optional<double>& gained, const std::optional<double>& base) {
  const bool has_one = gained && std::isfinite(*gained) && std::isfinite(*base) && *base != 0.0;
  return has_one ? std::optional(*gained / std::abs(*base)) : std::nullopt;
}

std::string signed_text(const std::string& magnitude, double value) {
  return fmt::format("{}{}", value > 0.0 ? "+" : value < 0.0 ? "-" : "", magnitude);
}

/// One decimal, or one digit of what would look like 0.
std::string percent_text(double share) {
  const double percent = 100.0 * share;
  constexpr double kLeastOfDecimal = 0.05;
  return percent < kLeastOfDecimal ? fmt::format("{:.1g}", percent) : fmt::format("{:.1f}", percent);
}

std::string gain_text(const ScoreKind& kind, const std::optional<double>& gained, const std::optional<double>& share) {
  if (!gained) return std::string(kNoValue);
  const double scale = kind.share ? 100.0 : 1.0;
  std::string text = signed_text(digits(scale * std::abs(*gained)), *gained);
  if (share) text += fmt::format(" ({} %)", signed_text(percent_text(std::abs(*share)), *share));
  return text;
}

Mark direction(const std::optional<double>& gained) {
  return !gained || *gained == 0.0 ? Mark::kNone : *gained > 0.0 ? Mark::kBetter : Mark::kWorse;
}

ScoreTable gain_table(const ComparisonScores& comparison, std::size_t baseline) {
  ScoreTable table{"gains", fmt::format("Better (+) or worse (-) than {}", comparison.names[baseline]), kHeads, {}, {},
                   {}};
  for (const ScoreKind& kind : comparison.kinds) {
    TableRow& row = table.rows.emplace_back(row_heads(kind));
    const std::optional<double> base = value_of(comparison.scores[baseline], kind);
    for (std::size_t i = 0; i < comparison.scores.size(); ++i) {
      if (i == baseline) continue;
      const auto gained = gain(kind, value_of(comparison.scores[i], kind), base);
      row.cells.push_back(
          {gain_text(kind, gained, relative(gained, base)), gained, direction(gained), all_digits(gained)});
    }
  }
  for (std::size_t i = 0; i < comparison.names.size(); ++i) {
    if (i != baseline) table.value_columns.push_back(comparison.names[i]);
  }
  return table;
}

std::vector<std::string> notes_on(const std::vector<SavedReport>& reports, const ComparisonOptions& options,
                                  ComparisonFormat format) {
  std::vector<std::string> notes;
  if (format == ComparisonFormat::kText) notes.emplace_back("* best, + second best; - no value");
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

std::string csv(const ComparisonScores& comparison, const std::optional<std::size_t>& baseline) {
  std::string text = "metric,part,at_m,unit,better";
  for (const std::string& name : comparison.names) text += fmt::format(",{}", csv_field(name));
  for (std::size_t i = 0; baseline && i < comparison.names.size(); ++i) {
    if (i == *baseline) continue;
    for (const char* what : {"better by", "better by, relative"})
      text += fmt::format(",{}", csv_field(fmt::format("{}: {}", comparison.names[i], what)));
  }
  text += "\n";
  for (const ScoreKind& kind : comparison.kinds) {
    text += fmt::format("{},{},{},{},{}", csv_field(kind.metric), kind.part, csv_digits(kind.at), csv_field(kind.unit),
                        kind.better);
    for (const auto& scores : comparison.scores) text += fmt::format(",{}", csv_number(value_of(scores, kind)));
    for (std::size_t i = 0; baseline && i < comparison.scores.size(); ++i) {
      if (i == *baseline) continue;
      const auto base = value_of(comparison.scores[*baseline], kind);
      const auto gained = gain(kind, value_of(comparison.scores[i], kind), base);
      text += fmt::format(",{},{}", csv_number(gained), csv_number(relative(gained, base)));
    }
    text += "\n";
  }
  return text;
}

std::string html(const std::vector<ScoreTable>& tables) {
  HtmlPage page("Comparison of maps");
  page.add_key("of each row; - no value. The tables sort by their headings.");
  for (const ScoreTable& table : tables) page.add_table(table);
  return page.finish();
}

}  // namespace

std::string format_comparison(const std::vector<SavedReport>& reports, const ComparisonOptions& options,
                              ComparisonFormat format) {
  const ComparisonScores comparison = scores_to_compare(reports, options);
  if (format == ComparisonFormat::kCsv) return csv(comparison, options.baseline);
  std::vector<ScoreTable> tables{score_table(comparison)};
  if (options.baseline && reports.size() > 1) {
    tables.push_back(gain_table(comparison, *options.baseline));
    if (auto intervals = gain_interval_table(reports, comparison, *options.baseline)) tables.push_back(*intervals);
  }
  tables.front().notes = notes_on(reports, options, format);
  switch (format) {
    case ComparisonFormat::kMarkdown:
      return typeset(tables, TableFormat::kMarkdown);
    case ComparisonFormat::kLatex:
      return typeset(tables, TableFormat::kLatex);
    case ComparisonFormat::kHtml:
      return html(tables);
    case ComparisonFormat::kText:
    case ComparisonFormat::kCsv:
      break;
  }
  return typeset(tables, TableFormat::kText);
}

}  // namespace cmap
