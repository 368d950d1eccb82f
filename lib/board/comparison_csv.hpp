#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "comparison_scores.hpp"
#include "ranking.hpp"

namespace cmap {

/// A row for each score, with all digits, and for each of its levels, "floor", "chance" and "phase_std"; by how much it
/// is better than the baseline's; and, unless `rankings` is empty, what is known of its best.
std::string comparison_csv(const ComparisonScores& comparison, const std::optional<std::size_t>& baseline,
                           const std::vector<std::optional<RankVerdict>>& rankings);

}  // namespace cmap
