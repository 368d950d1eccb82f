#include "distinguishable.hpp"

#include "report/report_testing.hpp"

namespace cmap {
namespace distinguishable_test {

using test::options_for;
using test::report_of;
using test::small_map;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::optional<Phases> phases(std::vector<std::optional<double>> values) { return Phases{std::move(values), 0.1, 0, 1}; }

TEST(ChangesSign, OverThePhasesThatBothHave) {
  EXPECT_EQ(changes_sign(phases({1.0, 2.0, 3.0}), phases({1.5, 2.1, 9.0})), false) << "above on every grid";
  EXPECT_EQ(changes_sign(phases({1.0, 2.0, 3.0}), phases({0.5, 1.9, 2.0})), false) << "below on every grid";
  EXPECT_EQ(changes_sign(phases({1.0, 2.0, 3.0}), phases({1.5, 2.1, 2.9})), true);
  EXPECT_EQ(changes_sign(phases({1.0, 2.0, 3.0}), phases({1.5, 2.0, 3.5})), true) << "no difference on one grid";
  EXPECT_EQ(changes_sign(phases({1.0, 2.0, {}}), phases({1.5, 2.1, 0.0})), false) << "the third is of one alone";
  EXPECT_EQ(changes_sign(phases({1.0, {}, 3.0}), phases({1.5, 2.1, {}})), std::nullopt) << "one in common";
  EXPECT_EQ(changes_sign(phases({1.0, 2.0}), phases({1.0, 2.0, 3.0})), std::nullopt) << "other grids";
  EXPECT_EQ(changes_sign(std::nullopt, phases({1.0, 2.0})), std::nullopt);
}

ScoreKind kind_of(const std::string& metric) {
  ScoreKind kind;
  kind.metric = metric;
  kind.better = "lower";
  return kind;
}

/// Maps that are known by one score each, without bootstrap.
class Phased {
 public:
  explicit Phased(const std::vector<Score>& scores) {
    for (const Score& score : scores) scores_.push_back({score});
    std::vector<const std::vector<Score>*> pointers;
    for (const auto& of_map : scores_) pointers.push_back(&of_map);
    distinction_.emplace(std::vector<const Json*>(scores.size(), nullptr), pointers);
  }
  RankVerdict verdict() { return distinction_->verdict(kind_of("average_wasserstein"), 0, 1); }
  std::string how() const { return distinction_->evidence().how(); }

 private:
  std::vector<std::vector<Score>> scores_;
  std::optional<Distinction> distinction_;
};

Score score(double value, std::optional<Phases> of = {}) {
  return {kind_of("average_wasserstein"), value, {}, {}, std::move(of)};
}

TEST(Distinction, ByThePhasesOfAGrid) {
  EXPECT_EQ(Phased({score(1, phases({1, 2})), score(2, phases({2, 3}))}).verdict(), RankVerdict::kDistinguishable);
  EXPECT_EQ(Phased({score(1, phases({1, 2})), score(2, phases({2, 1}))}).verdict(), RankVerdict::kNotDistinguishable);
  EXPECT_EQ(Phased({score(1, phases({1, 2})), score(2)}).verdict(), RankVerdict::kNoBootstrap) << "an old report";
  Phased phased({score(1, phases({1, 2})), score(2, phases({2, 3}))});
  EXPECT_EQ(phased.how(), "") << "nothing was asked yet";
  phased.verdict();
  EXPECT_EQ(phased.how(), "over the grid's phases");
}

TEST(Distinction, WhatNeedsNoTest) {
  EXPECT_EQ(Phased({score(1), score(1)}).verdict(), RankVerdict::kNotDistinguishable) << "the same value";
  EXPECT_EQ(Phased({score(INFINITY), score(40)}).verdict(), RankVerdict::kDistinguishable);
  EXPECT_EQ(Phased({score(40), score(INFINITY)}).verdict(), RankVerdict::kDistinguishable);
  EXPECT_EQ(Phased({score(INFINITY), score(INFINITY)}).verdict(), RankVerdict::kNotDistinguishable);
}

/// 40 x 40 points, 1 m apart, at one height for x below 20 m and another for the rest.
PointCloud plane(float height, float other_height) {
  std::vector<Eigen::Vector3f> positions;
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 40; ++y)
      positions.emplace_back(static_cast<float>(x), static_cast<float>(y), x < 20 ? height : other_height);
  }
  return small_map(positions);
}

/// The reports of planes over the plane at height 0: chamfer is twice the mean height.
class Planes {
 public:
  Planes(const std::vector<PointCloud>& maps, double block_m, std::uint64_t n_replicates = 200) {
    EvaluationOptions options = options_for({"chamfer", "hausdorff"});
    options.bootstrap = n_replicates;
    options.block_m = block_m;
    for (const PointCloud& map : maps) reports_.push_back(report_of(plane(0.0f, 0.0f), map, options));
    for (const Json& report : reports_) scores_.push_back(scores_of(report));
  }

  Json& report(std::size_t i) { return reports_[i]; }
  Distinction distinction() const {
    std::vector<const Json*> reports;
    std::vector<const std::vector<Score>*> scores;
    for (std::size_t i = 0; i < reports_.size(); ++i) {
      reports.push_back(&reports_[i]);
      scores.push_back(&scores_[i]);
    }
    return Distinction(std::move(reports), std::move(scores));
  }
  RankVerdict verdict(const std::string& metric, std::size_t a, std::size_t b) const {
    return distinction().verdict(kind_of(metric), a, b);
  }

 private:
  std::vector<Json> reports_;
  std::vector<std::vector<Score>> scores_;
};

TEST(Distinction, ByTheIntervalOfThePairedDifference) {
  // The second is 0.125 m worse in every block; the third 0.125 m worse in one half and a little more than that better
  // in the other: whatever blocks are drawn decides.
  const Planes planes({plane(0.25f, 0.25f), plane(0.375f, 0.375f), plane(0.375f, 0.12f)}, 5.0);
  EXPECT_EQ(planes.verdict("chamfer", 0, 1), RankVerdict::kDistinguishable);
  EXPECT_EQ(planes.verdict("chamfer", 1, 0), RankVerdict::kDistinguishable);
  EXPECT_EQ(planes.verdict("chamfer", 0, 2), RankVerdict::kNotDistinguishable);
  EXPECT_EQ(planes.verdict("chamfer", 2, 0), RankVerdict::kNotDistinguishable);
  EXPECT_EQ(planes.verdict("hausdorff", 0, 1), RankVerdict::kNoInterval) << "a maximum has none";
}

TEST(Distinction, WithoutBlocksOrWithOthersIsNotTested) {
  Planes planes({plane(0.25f, 0.25f), plane(0.375f, 0.375f)}, 5.0);
  planes.report(1)["intervals"]["blocks"]["block_m"] = 4.0;
  EXPECT_EQ(planes.verdict("chamfer", 0, 1), RankVerdict::kNoInterval);
  planes.report(1).erase("intervals");
  EXPECT_EQ(planes.verdict("chamfer", 0, 1), RankVerdict::kNoBootstrap);
  const Planes one_block({plane(0.25f, 0.25f), plane(0.375f, 0.375f)}, 1000.0);
  EXPECT_EQ(one_block.verdict("chamfer", 0, 1), RankVerdict::kNoInterval) << "one block has no spread";
}

TEST(RankingNotes, SayWhereIntervalsComeFromFewBlocks) {
  const auto notes = [](double block_m) {
    const Planes planes({plane(0.25f, 0.25f), plane(0.375f, 0.375f)}, block_m);
    Distinction distinction = planes.distinction();
    RankingCounts counts;
    counts.add(distinction.verdict(kind_of("chamfer"), 0, 1));
    return ranking_notes(counts, distinction.evidence());
  };
  const auto says = HasSubstr("1 of 1 ranking distinguishable at 95 %");
  EXPECT_THAT(notes(5.0), ElementsAre(says, HasSubstr("share their mark"))) << "64 blocks";
  EXPECT_THAT(notes(20.0), ElementsAre(says, HasSubstr("share their mark"), HasSubstr("intervals from 4 blocks")));
  EXPECT_TRUE(ranking_notes({}, {}).empty());
}

}  // namespace distinguishable_test
}  // namespace cmap
