#pragma once

#include <optional>

#include "comparison_scores.hpp"
#include "score_table.hpp"

namespace cmap {

/// Between what the gains over the baseline lie, by the bootstrap of the differences: both reports are computed from
/// the same drawn blocks, so that what is hard for both cancels. None where a report has no intervals, or where blocks
/// differ in size.
std::optional<ScoreTable> gain_interval_table(const std::vector<SavedReport>& reports,
                                              const ComparisonScores& comparison, std::size_t baseline);

}  // namespace cmap
