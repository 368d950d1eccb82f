#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "score_table.hpp"

namespace cmap {

/// Whether two methods can be told apart.
enum class RankVerdict {
  kDistinguishable,
  kNotDistinguishable,
  kNoBootstrap,  ///< not tested: a report was made without --bootstrap
  kNoInterval    ///< not tested: there is no interval of this difference
};

/// Between two cells of those that are ranked, by their indices.
using VerdictOf = std::function<RankVerdict(std::size_t, std::size_t)>;

/// Marks the cells that have a value: all that are not distinguishable from the best share its mark, and of the others
/// all that are not distinguishable from the best of them the second. Cells that look the same are not distinguishable.
/// Where the best was not tested against every other, it has the mark that says so, and there is no second; where the
/// best of the others was not, there is no second. Returns what is known of the best against every other: nothing where
/// `better` is neither "lower" nor "higher" or fewer than two have a value.
std::optional<RankVerdict> mark_distinguishable(const std::vector<TableCell*>& cells, std::string_view better,
                                                const VerdictOf& verdict_of);

/// How many rankings of a document are distinguishable.
class RankingCounts {
 public:
  void add(const std::optional<RankVerdict>& ranking);
  void add(const RankingCounts& others);

  bool has_tested() const { return of(RankVerdict::kDistinguishable) + of(RankVerdict::kNotDistinguishable) > 0; }
  /// "5 of 12 rankings distinguishable at 95 %, 4 not, 3 not tested (no --bootstrap)"; `how` is "at 95 %". Empty where
  /// there is no ranking.
  std::string text(std::string_view how) const;

 private:
  std::size_t of(RankVerdict verdict) const { return counts_[static_cast<std::size_t>(verdict)]; }

  std::size_t counts_[4] = {};
};

}  // namespace cmap
