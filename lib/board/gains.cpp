#include "gains.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cmap/report/table_text.hpp"

namespace cmap {
namespace {

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

}  // namespace

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

ScoreTable gain_table(const ComparisonScores& comparison, std::size_t baseline) {
  ScoreTable table{
      "gains", fmt::format("Better (+) or worse (-) than {}", comparison.names[baseline]), kMetricHeads, {}, {}, {}};
  for (const ScoreKind& kind : comparison.kinds) {
    TableRow& row = table.rows.emplace_back(metric_row(kind));
    const std::optional<double> base = value_of(comparison.scores[baseline], kind);
    for (std::size_t i = 0; i < comparison.scores.size(); ++i) {
      if (i == baseline) continue;
      const auto gained = gain(kind, value_of(comparison.scores[i], kind), base);
      row.cells.push_back({gain_text(kind, gained, relative(gained, base)), gained, direction(gained),
                           gained ? fmt::format("{}", *gained) : "no value"});
    }
  }
  for (std::size_t i = 0; i < comparison.names.size(); ++i) {
    if (i != baseline) table.value_columns.push_back(comparison.names[i]);
  }
  return table;
}

}  // namespace cmap
