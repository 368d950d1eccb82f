#pragma once

#include <optional>

#include "comparison_scores.hpp"
#include "paired_bootstrap.hpp"
#include "score_table.hpp"

namespace cmap {

/// Between what the gains over the baseline lie, by the bootstrap of the differences. None where a report has no
/// intervals, or where blocks differ in size.
std::optional<ScoreTable> gain_interval_table(PairedBootstrap& bootstrap, const ComparisonScores& comparison,
                                              std::size_t baseline);

}  // namespace cmap
