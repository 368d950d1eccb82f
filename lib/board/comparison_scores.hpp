#pragma once

#include <string>
#include <vector>

#include "cmap/board/comparison.hpp"
#include "score_table.hpp"
#include "scores.hpp"

namespace cmap {

/// What a comparison shows of its reports.
struct ComparisonScores {
  std::vector<std::string> names;
  std::vector<std::vector<Score>> scores;  ///< by report
  std::vector<ScoreKind> kinds;            ///< rows
};

/// Throws UsageError for an unknown metric, or where none is left.
ComparisonScores scores_to_compare(const std::vector<SavedReport>& reports, const ComparisonOptions& options);

/// The columns at the left of tables whose rows are scores, and such a row without its cells.
extern const std::vector<std::string> kMetricHeads;
TableRow metric_row(const ScoreKind& kind);

/// Shares in percent, others with four digits.
std::string shown_value(const ScoreKind& kind, const std::optional<double>& value);
std::string shown_unit(const ScoreKind& kind);
std::string arrow(const ScoreKind& kind);

}  // namespace cmap
