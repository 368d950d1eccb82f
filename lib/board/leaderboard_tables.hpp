#pragma once

#include <string>
#include <vector>

#include "cmap/board/leaderboard.hpp"
#include "distinguishable.hpp"
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

/// "accuracy (AC)"; skill and coverage stand under their metric.
std::string heading_of(const ScoreKind& kind);

/// "color distance (CD) ↓ [of 255]".
std::string title_of(const ScoreKind& kind);
std::string table_id(const ScoreKind& kind, const char* of);

/// Published numbers of a score, and those of registration; nothing where there are none. The best are marked as not
/// tested, unless `is_plain`.
std::optional<ScoreTable> published_table(const ScoreKind& kind, const PublishedScores& published, bool is_plain);
std::optional<ScoreTable> registration_table(const LeaderboardManifest& manifest, bool is_plain);

/// What stands about one score: our table, and what was published.
struct ScoreSection {
  ScoreKind kind;
  ScoreTable computed;                  ///< rows are methods, columns sequences
  std::optional<ScoreTable> published;  ///< in the order of its source
  RankingCounts rankings;               ///< of the computed columns
};

/// What all documents of a leaderboard are made of.
struct LeaderboardScores {
  std::vector<std::vector<Score>> scores;  ///< by pair
  std::vector<ScoreSection> sections;      ///< what the options ask for or was published, in the catalog's order
  std::optional<ScoreTable> registration;  ///< as published; nothing where nothing was
  Evidence evidence;                       ///< of all rankings
};
LeaderboardScores leaderboard_scores(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                                     const LeaderboardLook& look = {});

/// How much the rankings say, which pairs have no report or skill and why, and what is to know about the published
/// numbers.
std::vector<std::string> leaderboard_notes(const LeaderboardManifest& manifest,
                                           const std::vector<LeaderboardPair>& pairs, const LeaderboardScores& scores);

/// One line for each score of each pair, computed, published and normalized, with all digits.
std::string leaderboard_csv(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                            const LeaderboardScores& scores);

/// The page with all tables, pictures and links.
std::string leaderboard_html(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                             const LeaderboardScores& scores, const LeaderboardLook& look);

}  // namespace cmap
