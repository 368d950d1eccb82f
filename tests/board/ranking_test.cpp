#include "ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace cmap {
namespace ranking_test {

constexpr RankVerdict kApart = RankVerdict::kDistinguishable, kAlike = RankVerdict::kNotDistinguishable,
                      kUntested = RankVerdict::kNoBootstrap;

/// What is known of pairs; of all others `else_`.
struct Known {
  RankVerdict else_;
  std::map<std::pair<std::size_t, std::size_t>, RankVerdict> pairs = {};

  RankVerdict operator()(std::size_t a, std::size_t b) const {
    const auto found = pairs.find({std::min(a, b), std::max(a, b)});
    return found == pairs.end() ? else_ : found->second;
  }
};

struct Ranked {
  std::string marks;  ///< one sign for each cell
  std::optional<RankVerdict> verdict;
};

bool operator==(const Ranked& a, const Ranked& b) { return a.marks == b.marks && a.verdict == b.verdict; }
void PrintTo(const Ranked& ranked, std::ostream* out) {
  *out << ranked.marks << " " << (ranked.verdict ? static_cast<int>(*ranked.verdict) : -1);
}

Ranked ranked(std::vector<TableCell> cells, const VerdictOf& verdict_of, std::string_view better = "lower") {
  std::vector<TableCell*> pointers;
  for (TableCell& cell : cells) pointers.push_back(&cell);
  Ranked result{"", mark_distinguishable(pointers, better, verdict_of)};
  for (const TableCell& cell : cells) {
    result.marks += cell.mark == Mark::kBest           ? '*'
                    : cell.mark == Mark::kSecond       ? '+'
                    : cell.mark == Mark::kBestUntested ? '?'
                                                       : '.';
  }
  return result;
}

TableCell cell(const std::string& text, std::optional<double> value) { return {text, value, Mark::kNone, ""}; }

TableCell number(double value) { return cell(std::to_string(value), value); }

const TableCell kNothing = cell("-", {});

TEST(MarkDistinguishable, WhatIsApartIsRankedByValue) {
  EXPECT_EQ(ranked({number(2), number(1), number(3)}, Known{kApart}), (Ranked{"+*.", kApart}));
  EXPECT_EQ(ranked({number(2), number(1), number(3)}, Known{kApart}, "higher"), (Ranked{"+.*", kApart}));
}

TEST(MarkDistinguishable, WhatIsAlikeSharesItsMark) {
  EXPECT_EQ(ranked({number(1), number(2)}, Known{kAlike}), (Ranked{"**", kAlike}));
  const Known two_pairs{kApart, {{{0, 1}, kAlike}, {{2, 3}, kAlike}}};
  EXPECT_EQ(ranked({number(1), number(2), number(3), number(4), number(5)}, two_pairs), (Ranked{"**++.", kAlike}));
  const Known second_alike{kApart, {{{1, 2}, kAlike}}};
  EXPECT_EQ(ranked({number(1), number(2), number(3)}, second_alike), (Ranked{"*++", kApart}));
}

/// 1 may be no better than 2, and 2 no better than 3, while 1 is better than 3: being alike is not handed on.
TEST(MarkDistinguishable, AlikeIsMeasuredAgainstTheBest) {
  const Known chain{kAlike, {{{0, 2}, kApart}}};
  EXPECT_EQ(ranked({number(1), number(2), number(3)}, chain), (Ranked{"**+", kAlike}));
  const Known leap{kApart, {{{0, 2}, kAlike}}};
  EXPECT_EQ(ranked({number(1), number(2), number(3)}, leap), (Ranked{"*+*", kAlike})) << "3 is noisier than 2";
}

TEST(MarkDistinguishable, WhatNobodyTestedIsNeverSimplyBest) {
  EXPECT_EQ(ranked({number(2), number(1), number(3)}, Known{kUntested}), (Ranked{".?.", kUntested}));
  const Known one_untested{kApart, {{{0, 2}, RankVerdict::kNoInterval}}};
  EXPECT_EQ(ranked({number(1), number(2), number(3)}, one_untested), (Ranked{"?..", RankVerdict::kNoInterval}));
  const Known second_untested{kApart, {{{1, 2}, kUntested}}};
  EXPECT_EQ(ranked({number(1), number(2), number(3)}, second_untested), (Ranked{"*..", kApart}));
}

TEST(MarkDistinguishable, WhatLooksTheSameIsAlike) {
  const TableCell same = cell("82.50", 0.82498), as_same = cell("82.50", 0.825), worse = cell("70.00", 0.7);
  EXPECT_EQ(ranked({same, as_same, worse}, Known{kApart}, "higher"), (Ranked{"**+", kAlike}));
  EXPECT_EQ(ranked({same, as_same, worse}, Known{kUntested}, "higher"), (Ranked{"??.", kUntested}));
  const TableCell endless = cell("∞", INFINITY);
  EXPECT_EQ(ranked({endless, number(40), endless}, Known{kApart}, "higher"), (Ranked{"*+*", kAlike}));
}

TEST(MarkDistinguishable, NothingIsNoRanking) {
  EXPECT_EQ(ranked({number(1), number(2)}, Known{kApart}, ""), (Ranked{"..", std::nullopt})) << "neither is better";
  EXPECT_EQ(ranked({number(1), kNothing}, Known{kApart}), (Ranked{"..", std::nullopt}));
  EXPECT_EQ(ranked({kNothing, number(2), number(1)}, Known{kApart}), (Ranked{".+*", kApart}));
}

TEST(RankingCounts, SayHowManyAreDistinguishable) {
  RankingCounts counts;
  EXPECT_EQ(counts.text("at 95 %"), "");
  counts.add(std::nullopt);
  EXPECT_EQ(counts.text("at 95 %"), "") << "no ranking";
  counts.add(kUntested);
  EXPECT_EQ(counts.text(""), "0 of 1 ranking distinguishable, 1 not tested (no --bootstrap)");
  EXPECT_FALSE(counts.has_tested());
  for (const RankVerdict verdict : {kApart, kApart, kAlike, RankVerdict::kNoInterval}) counts.add(verdict);
  EXPECT_TRUE(counts.has_tested());
  EXPECT_EQ(
      counts.text("at 95 %"),
      "2 of 5 rankings distinguishable at 95 %, 1 not, 1 not tested (no --bootstrap), 1 not tested (no interval of "
      "the difference)");
  RankingCounts all;
  all.add(counts);
  all.add(counts);
  EXPECT_THAT(all.text(""), ::testing::StartsWith("4 of 10 rankings distinguishable, 2 not, "));
}

}  // namespace ranking_test
}  // namespace cmap
