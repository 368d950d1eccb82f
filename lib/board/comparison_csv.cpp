#include "comparison_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "gains.hpp"
#include "score_table.hpp"

namespace cmap {
namespace {

std::string heads(const ComparisonScores& comparison, const std::optional<std::size_t>& baseline) {
  std::string text = "metric,part,at_m,unit,better";
  for (const std::string& name : comparison.names) text += fmt::format(",{}", csv_field(name));
  for (std::size_t i = 0; baseline && i < comparison.names.size(); ++i) {
    if (i == *baseline) continue;
    for (const char* what : {"better by", "better by, relative"})
      text += fmt::format(",{}", csv_field(fmt::format("{}: {}", comparison.names[i], what)));
  }
  return text;
}

std::string row_heads(const ScoreKind& kind, std::string_view part, std::string_view better) {
  return fmt::format("{},{},{},{},{}", csv_field(kind.metric), part, csv_digits(kind.at), csv_field(kind.unit), better);
}

std::string gain_fields(const ComparisonScores& comparison, const ScoreKind& kind, std::size_t baseline) {
  std::string text;
  const std::optional<double> base = value_of(comparison.scores[baseline], kind);
  for (std::size_t i = 0; i < comparison.scores.size(); ++i) {
    if (i == baseline) continue;
    const auto gained = gain(kind, value_of(comparison.scores[i], kind), base);
    text += fmt::format(",{},{}", csv_number(gained), csv_number(relative(gained, base)));
  }
  return text;
}

struct Level {
  const char* part;
  std::function<std::optional<double>(const Score&)> of;
};

/// Rows of what a score is worth, where a report says it; `blanks` are the fields behind the values.
std::string level_rows(const ComparisonScores& comparison, const ScoreKind& kind, const std::string& blanks) {
  const std::vector<Level> levels{
      {"floor", [](const Score& s) { return s.floor; }},
      {"chance", [](const Score& s) { return s.chance; }},
      {"phase_std", [](const Score& s) { return s.phases ? std::optional(s.phases->std) : std::nullopt; }}};
  std::string text;
  for (const Level& level : levels) {
    std::vector<std::optional<double>> values;
    for (const auto& scores : comparison.scores) {
      const Score* score = score_of(scores, kind);
      values.push_back(score == nullptr ? std::nullopt : level.of(*score));
    }
    if (std::ranges::none_of(values, [](const auto& value) { return value.has_value(); })) continue;
    text += row_heads(kind, level.part, "");
    for (const auto& value : values) text += fmt::format(",{}", csv_number(value));
    text += blanks + "\n";
  }
  return text;
}

const char* ranking_name(const std::optional<RankVerdict>& ranking) {
  if (!ranking) return "";
  return *ranking == RankVerdict::kDistinguishable      ? "distinguishable"
         : *ranking == RankVerdict::kNotDistinguishable ? "not distinguishable"
                                                        : "not tested";
}

}  // namespace

std::string comparison_csv(const ComparisonScores& comparison, const std::optional<std::size_t>& baseline,
                           const std::vector<std::optional<RankVerdict>>& rankings) {
  const std::size_t n_gains = baseline ? 2 * (comparison.names.size() - 1) : 0;
  const std::string blanks(n_gains + (rankings.empty() ? 0 : 1), ',');
  std::string text = heads(comparison, baseline) + (rankings.empty() ? "" : ",ranking") + "\n";
  for (std::size_t row = 0; row < comparison.kinds.size(); ++row) {
    const ScoreKind& kind = comparison.kinds[row];
    text += row_heads(kind, kind.part, kind.better);
    for (const auto& scores : comparison.scores) text += fmt::format(",{}", csv_number(value_of(scores, kind)));
    if (baseline) text += gain_fields(comparison, kind, *baseline);
    if (!rankings.empty()) text += fmt::format(",{}", ranking_name(rankings[row]));
    text += "\n" + level_rows(comparison, kind, blanks);
  }
  return text;
}

}  // namespace cmap
