#pragma once

#include <optional>

#include "comparison_scores.hpp"
#include "score_table.hpp"

namespace cmap {

/// By how much `value` is better than `base`, in the metric's unit: negative where it is worse.
std::optional<double> gain(const ScoreKind& kind, const std::optional<double>& value,
                           const std::optional<double>& base);

/// A gain as a share of what it is over; nothing for infinite ones, and over nothing.
std::optional<double> relative(const std::optional<double>& gained, const std::optional<double>& base);

/// By how much each report is better (+) or worse (-) than the baseline.
ScoreTable gain_table(const ComparisonScores& comparison, std::size_t baseline);

}  // namespace cmap
