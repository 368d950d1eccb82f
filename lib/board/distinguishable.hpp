#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "paired_bootstrap.hpp"
#include "ranking.hpp"
#include "scores.hpp"

namespace cmap {

/// Whether the difference b - a is above zero on one grid and not on another, or the other way around; the same value
/// is no difference. Nothing where fewer than two grids have both values, or the grids are others.
std::optional<bool> changes_sign(const std::optional<Phases>& a, const std::optional<Phases>& b);

/// What verdicts come from.
struct Evidence {
  std::optional<std::size_t> fewest_blocks = {};  ///< of all intervals; nothing where there was none
  double level = 0.95;                            ///< of the intervals
  bool has_phases = false;

  void add(const Evidence& other);
  /// "at 95 %", "over the grid's phases" or both.
  std::string how() const;
};

/// Tells maps of one reference apart. Two are not distinguishable on a score where the interval of their paired
/// difference holds 0, or the difference's sign changes over the grid's phases; where neither is there, it is not
/// tested. Equal values never are, and an infinite one always is from a finite one.
class Distinction {
 public:
  /// Report and scores of each map; a null report has no scores. Both must outlive it.
  Distinction(std::vector<const nlohmann::ordered_json*> reports, std::vector<const std::vector<Score>*> scores);

  /// Of maps a and b, which both must have the score's value.
  RankVerdict verdict(const ScoreKind& kind, std::size_t a, std::size_t b);
  PairedBootstrap& bootstrap() { return bootstrap_; }

  /// Of the verdicts so far.
  const Evidence& evidence() const { return evidence_; }

 private:
  std::optional<bool> holds_zero(const ScoreKind& kind, std::size_t a, std::size_t b);

  std::vector<const std::vector<Score>*> scores_;
  PairedBootstrap bootstrap_;
  Evidence evidence_;
};

/// What a document says about its rankings: how many are distinguishable, what shares a mark, and where intervals come
/// from few blocks.
std::vector<std::string> ranking_notes(const RankingCounts& counts, const Evidence& evidence);

}  // namespace cmap
