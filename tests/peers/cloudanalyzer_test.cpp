#include "cmap/peers/cloudanalyzer.hpp"

#include <cmath>
#include <numbers>

#include "peers/peers_testing.hpp"

namespace cmap {
namespace cloudanalyzer_test {

using test::diagonal;
using test::Doubles;
using test::kZero;

TEST(CloudAnalyzer, CurveByHand) {
  // Thresholds 0.05, 0.1, 0.2, 0.3, 0.5, 1: F is 0, then 2/3 from 0.3 on (P 1/2, R 1), inclusive.
  const Doubles estimate{0.09, 4.0}, reference{0.0625};
  const CloudAnalyzerCurve curve = cloudanalyzer_curve(estimate, reference);
  ASSERT_EQ(curve.scores.size(), 6U);
  EXPECT_EQ(curve.scores[2].f1, 0.0);
  EXPECT_EQ(curve.scores[3].precision, 0.5);
  EXPECT_EQ(curve.scores[3].recall, 1.0);
  EXPECT_DOUBLE_EQ(curve.scores[3].f1, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(curve.auc, (0.1 * (1.0 / 3.0) + 0.7 * (2.0 / 3.0)) / 0.95);
}

TEST(CloudAnalyzer, SummaryByHand) {
  const CloudAnalyzerSummary found = cloudanalyzer_summary(Doubles{1.0, 9.0, 25.0, 49.0});
  EXPECT_DOUBLE_EQ(found.mean_m, 4.0);
  EXPECT_EQ(found.median_m, 4.0);
  EXPECT_EQ(found.max_m, 7.0);
  EXPECT_DOUBLE_EQ(found.standard_deviation_m, std::sqrt(5.0));  // population
}

TEST(CloudAnalyzer, StructureRaisesEigenvaluesAndCountsVoxelsAmongEqualOnes) {
  const auto pair_at = [](std::int64_t x, double spread) {
    return GaussianPair{
        {x, 0, 0}, {101, kZero, diagonal(0, 0, 0)}, {101, kZero, 100.0 * diagonal(spread, spread, spread)}};
  };
  // Covariances 0 against s^2 I become 1e-6 I against s^2 I: sqrt 3 (s - 1e-3), for s = 1 and 2; the third has no
  // others.
  const std::vector<GaussianPair> pairs{pair_at(0, 1.0), pair_at(1, 4.0), pair_at(100, 0.0)};
  const CloudAnalyzerStructure found = cloudanalyzer_structure(pairs, 5);
  EXPECT_NEAR(found.awd_m, std::numbers::sqrt3 * (0.999 + 1.999) / 3.0, 1e-12);
  EXPECT_EQ(found.n_awd_voxels, 3U);
  EXPECT_EQ(found.n_scs_voxels, 2U);
  EXPECT_EQ(found.scs, 0.0) << "one other voxel has no spread";
  const CloudAnalyzerStructure zeros =
      cloudanalyzer_structure(std::vector<GaussianPair>{pair_at(0, 0.0), pair_at(1, 0.0)}, 5);
  EXPECT_EQ(zeros.n_scs_voxels, 2U) << "ours leaves such voxels out";
  EXPECT_EQ(zeros.scs, 0.0);
  EXPECT_TRUE(std::isnan(cloudanalyzer_structure({}, 5).awd_m));
}

}  // namespace cloudanalyzer_test
}  // namespace cmap
