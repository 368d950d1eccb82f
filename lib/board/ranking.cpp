#include "ranking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace cmap {
namespace {

/// The best of some cells, and which of them it may be no better than.
struct Leaders {
  std::vector<std::size_t> shared, others;  ///< by rank; the best is the first that shares
  std::vector<std::size_t> look_the_same;   ///< of those that share
  RankVerdict verdict = RankVerdict::kDistinguishable;
};

/// `ranked` are indices of cells, the best first.
Leaders leaders_of(const std::vector<std::size_t>& ranked, const std::vector<TableCell*>& cells,
                   const VerdictOf& verdict_of) {
  Leaders leaders{{ranked.front()}, {}, {ranked.front()}};
  std::optional<RankVerdict> untested;
  for (const std::size_t cell : ranked) {
    if (cell == ranked.front()) continue;
    const bool looks_the_same = cells[cell]->text == cells[ranked.front()]->text;
    const RankVerdict verdict = looks_the_same ? RankVerdict::kNotDistinguishable : verdict_of(ranked.front(), cell);
    if (looks_the_same) leaders.look_the_same.push_back(cell);
    if (verdict == RankVerdict::kNoBootstrap || verdict == RankVerdict::kNoInterval)
      untested = untested.value_or(verdict);
    (verdict == RankVerdict::kNotDistinguishable ? leaders.shared : leaders.others).push_back(cell);
  }
  if (leaders.shared.size() > 1) leaders.verdict = RankVerdict::kNotDistinguishable;
  leaders.verdict = untested.value_or(leaders.verdict);
  return leaders;
}

bool is_tested(RankVerdict verdict) {
  return verdict == RankVerdict::kDistinguishable || verdict == RankVerdict::kNotDistinguishable;
}

void mark_all(const std::vector<std::size_t>& chosen, const std::vector<TableCell*>& cells, Mark mark) {
  for (const std::size_t cell : chosen) cells[cell]->mark = mark;
}

}  // namespace

std::optional<RankVerdict> mark_distinguishable(const std::vector<TableCell*>& cells, std::string_view better,
                                                const VerdictOf& verdict_of) {
  const std::vector<std::size_t> ranked = ranked_cells(cells, better);
  if (ranked.size() < 2) return std::nullopt;
  const Leaders best = leaders_of(ranked, cells, verdict_of);
  if (!is_tested(best.verdict)) {
    mark_all(best.look_the_same, cells, Mark::kBestUntested);
    return best.verdict;
  }
  mark_all(best.shared, cells, Mark::kBest);
  if (best.others.empty()) return best.verdict;
  const Leaders second = leaders_of(best.others, cells, verdict_of);
  if (is_tested(second.verdict)) mark_all(second.shared, cells, Mark::kSecond);
  return best.verdict;
}

void RankingCounts::add(const std::optional<RankVerdict>& ranking) {
  if (ranking) ++counts_[static_cast<std::size_t>(*ranking)];
}

void RankingCounts::add(const RankingCounts& others) {
  for (std::size_t i = 0; i < std::size(counts_); ++i) counts_[i] += others.counts_[i];
}

std::string RankingCounts::text(std::string_view how) const {
  std::size_t n = 0;
  for (const std::size_t count : counts_) n += count;
  if (n == 0) return "";
  std::string text =
      fmt::format("{} of {} ranking{} distinguishable", of(RankVerdict::kDistinguishable), n, n == 1 ? "" : "s");
  if (!how.empty()) text += fmt::format(" {}", how);
  const auto add_count = [&](RankVerdict verdict, const char* what) {
    if (of(verdict) > 0) text += fmt::format(", {} {}", of(verdict), what);
  };
  add_count(RankVerdict::kNotDistinguishable, "not");
  add_count(RankVerdict::kNoBootstrap, "not tested (no --bootstrap)");
  add_count(RankVerdict::kNoInterval, "not tested (no interval of the difference)");
  return text;
}

}  // namespace cmap
