#pragma once

#include <string>
#include <vector>

#include "cmap/board/leaderboard.hpp"
#include "score_table.hpp"
#include "scores.hpp"

namespace cmap {

/// MapEval's headline level in meters: accuracy and fitness are published for it.
inline constexpr const char* kPublishedThreshold = "0.2";

/// How the paper prints a metric: color distance of 255, color consistency times 100, overlap and recall in percent.
struct PaperScale {
  double factor = 1.0;
  std::string unit;
};
PaperScale paper_scale(const ScoreKind& kind);

/// "accuracy (AC)"; coverage stands under recall.
std::string heading_of(const ScoreKind& kind);

/// What stands about one score: our table, and what was published.
struct ScoreSection {
  ScoreKind kind;
  ScoreTable computed;                  ///< rows are methods, columns sequences
  std::optional<ScoreTable> published;  ///< in the order of its source
};

/// All scores that the options ask for or that were published, in the catalog's order.
std::vector<ScoreSection> leaderboard_sections(const LeaderboardManifest& manifest,
                                               const std::vector<LeaderboardPair>& pairs);

/// The published table of registration; nothing where there is none.
std::optional<ScoreTable> registration_table(const LeaderboardManifest& manifest);

/// What the marks mean, which pairs have no report and why, and what is to know about the published numbers.
std::vector<std::string> leaderboard_notes(const LeaderboardManifest& manifest,
                                           const std::vector<LeaderboardPair>& pairs);

/// One line for each score of each pair, computed, published and normalized, with all digits.
std::string leaderboard_csv(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs);

/// The page with all tables, pictures and links.
std::string leaderboard_html(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs);

}  // namespace cmap
