#include "distinguishable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// As the warning of an evaluation, intervals_few_blocks.
constexpr std::size_t kFewBlocks = 20;

}  // namespace

std::optional<bool> changes_sign(const std::optional<Phases>& a, const std::optional<Phases>& b) {
  if (!a || !b || a->values.size() != b->values.size()) return std::nullopt;
  std::size_t n = 0, n_above = 0, n_below = 0;
  for (std::size_t i = 0; i < a->values.size(); ++i) {
    const std::optional<double>&of_a = a->values[i], &of_b = b->values[i];
    if (!of_a || !of_b) continue;
    ++n;
    n_above += *of_b > *of_a ? 1 : 0;
    n_below += *of_b < *of_a ? 1 : 0;
  }
  constexpr std::size_t kLeast = 2;
  if (n < kLeast) return std::nullopt;
  return n_above < n && n_below < n;
}

void Evidence::add(const Evidence& other) {
  has_phases = has_phases || other.has_phases;
  if (!other.fewest_blocks) return;
  fewest_blocks = std::min(fewest_blocks.value_or(*other.fewest_blocks), *other.fewest_blocks);
  level = other.level;
}

std::string Evidence::how() const {
  const std::string by_intervals = fmt::format("at {:g} %", 100.0 * level), by_phases = "over the grid's phases";
  if (fewest_blocks && has_phases) return by_intervals + " or " + by_phases;
  return fewest_blocks ? by_intervals : has_phases ? by_phases : "";
}

Distinction::Distinction(std::vector<const Json*> reports, std::vector<const std::vector<Score>*> scores)
    : scores_(std::move(scores)), bootstrap_(std::move(reports)) {}

std::optional<bool> Distinction::holds_zero(const ScoreKind& kind, std::size_t a, std::size_t b) {
  // One order of two maps is drawn for both.
  const std::size_t first = std::min(a, b), second = std::max(a, b);
  const Interval* interval = interval_of(bootstrap_.differences(first, second), kind);
  if (interval == nullptr) return std::nullopt;
  constexpr std::size_t kLeast = 2;  // one block is always drawn
  const std::size_t n_blocks = bootstrap_.n_blocks(first, second);
  if (n_blocks < kLeast) return std::nullopt;
  evidence_.add({n_blocks, bootstrap_.level(), false});
  return interval->lower <= 0.0 && interval->upper >= 0.0;
}

RankVerdict Distinction::verdict(const ScoreKind& kind, std::size_t a, std::size_t b) {
  const Score &of_a = *score_of(*scores_[a], kind), &of_b = *score_of(*scores_[b], kind);
  if (*of_a.value == *of_b.value) return RankVerdict::kNotDistinguishable;
  if (std::isinf(*of_a.value) || std::isinf(*of_b.value)) return RankVerdict::kDistinguishable;
  const std::optional<bool> changes = changes_sign(of_a.phases, of_b.phases), zero = holds_zero(kind, a, b);
  if (changes) evidence_.has_phases = true;
  if (changes || zero) {
    return changes.value_or(false) || zero.value_or(false) ? RankVerdict::kNotDistinguishable
                                                           : RankVerdict::kDistinguishable;
  }
  return bootstrap_.lacks_blocks(a) || bootstrap_.lacks_blocks(b) ? RankVerdict::kNoBootstrap
                                                                  : RankVerdict::kNoInterval;
}

std::vector<std::string> ranking_notes(const RankingCounts& counts, const Evidence& evidence) {
  std::vector<std::string> notes{counts.text(evidence.how())};
  if (notes.front().empty()) return {};
  if (counts.has_tested()) {
    notes.emplace_back(
        "methods that are not distinguishable share their mark: the interval of their paired difference holds 0, or "
        "its "
        "sign changes over the grid's phases");
  }
  if (evidence.fewest_blocks && *evidence.fewest_blocks < kFewBlocks) {
    notes.push_back(fmt::format("intervals from {} blocks are too narrow: evaluate with a smaller --block",
                                *evidence.fewest_blocks));
  }
  return notes;
}

}  // namespace cmap
