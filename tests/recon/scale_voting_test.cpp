#include "cmap/recon/scale_voting.hpp"

#include <set>

#include "prefusion/scale_correction.hpp"
#include "recon/recon_testing.hpp"

namespace cmap {
namespace scale_voting_test {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Ratio = std::optional<ScaleRatio>;

std::vector<SessionScale> sessions_of(const std::vector<double>& scales, double linearity = 0.9) {
  std::vector<SessionScale> sessions;
  for (const double s : scales) sessions.push_back({s, linearity, 0.005, true});
  return sessions;
}

std::vector<Ratio> ratios_of(const std::vector<double>& ratios) {
  std::vector<Ratio> result;
  for (const double r : ratios) result.push_back(ScaleRatio{r, 0.005, 1000});
  return result;
}

std::vector<Ratio> equal_units(std::size_t n_sessions) { return ratios_of(std::vector<double>(n_sessions - 1, 1.0)); }

ScaleVotingOptions with(ScaleVoting mode) {
  ScaleVotingOptions options;
  options.mode = mode;
  return options;
}

constexpr ScaleVoting kModes[] = {ScaleVoting::kRobust, ScaleVoting::kPaper};

TEST(ScaleVoting, OneSessionIsAccepted) {
  for (const ScaleVoting mode : kModes) {
    const VotedScales voted = vote_scales(sessions_of({17.0}), {}, with(mode));
    ASSERT_EQ(voted.scales.size(), 1u);
    EXPECT_NEAR(voted.scales[0], 17.0, 1e-12);
    EXPECT_THAT(voted.is_inlier, ElementsAre(1));
  }
}

TEST(ScaleVoting, EqualScalesAreAllInliers) {
  for (const ScaleVoting mode : kModes) {
    const VotedScales voted = vote_scales(sessions_of({20, 20, 20, 20, 20}), equal_units(5), with(mode));
    EXPECT_THAT(voted.is_inlier, Each(1));
    for (const double s : voted.scales) EXPECT_NEAR(s, 20.0, 1e-12);
    for (const double p : voted.weights) EXPECT_NEAR(p, 0.2, 1e-12);
    EXPECT_EQ(voted.alpha, 50.0);
  }
}

TEST(ScaleVoting, NearlyEqualScalesToo) {
  // std / mean falls below 1e-3 on the way: the vote must not lose anyone on either side.
  for (double spread = 1e-1; spread > 1e-9; spread *= 0.1) {
    for (const ScaleVoting mode : kModes) {
      const auto sessions =
          sessions_of({20, 20 * (1 + 0.05 * spread), 20 * (1 - 0.05 * spread), 20, 20 * (1 + 0.02 * spread)});
      const VotedScales voted = vote_scales(sessions, equal_units(5), with(mode));
      EXPECT_THAT(voted.is_inlier, Each(1)) << spread;
      EXPECT_TRUE(std::isfinite(voted.alpha) && voted.alpha <= 50.0);
    }
  }
}

TEST(ScaleVoting, OutliersOfTheStudy) {
  const VotedScales two = vote_scales(sessions_of({20, 20.3, 19.8, 20.1, 35, 33}), equal_units(6));
  EXPECT_THAT(two.is_inlier, ElementsAre(1, 1, 1, 1, 0, 0));
  for (const double s : two.scales) EXPECT_NEAR(s, 20.05, 0.25) << "units are equal, so scales are";
  const VotedScales gross = vote_scales(sessions_of({20, 20.3, 19.8, 20.1, 30, 120}), equal_units(6));
  EXPECT_THAT(gross.is_inlier, ElementsAre(1, 1, 1, 1, 0, 0));
  for (const double s : gross.scales) EXPECT_NEAR(s, 20.05, 0.25);
}

TEST(ScaleVoting, ThePaperIsMaskedByThem) {
  const auto sessions = sessions_of({20, 20.3, 19.8, 20.1, 30, 120});
  const VotedScales voted = vote_scales(sessions, equal_units(6), with(ScaleVoting::kPaper));
  double mean = 0.0, variance = 0.0;
  for (const auto& s : sessions) mean += s.scale / 6;
  for (const auto& s : sessions) variance += (s.scale - mean) * (s.scale - mean) / 6;
  EXPECT_NEAR(voted.tolerance, 2.0 * std::sqrt(variance), 1e-9);
  EXPECT_NEAR(voted.alpha, mean / std::sqrt(variance), 1e-9);
  // 120 is out; 30 hides behind the deviation that 120 makes.
  EXPECT_THAT(voted.is_inlier, ElementsAre(1, 1, 1, 1, 1, 0));
  EXPECT_NEAR(voted.scales[5], 30.0, 1e-12) << "the nearest inlier's";
  EXPECT_EQ(voted.scales[4], 30.0);
}

TEST(ScaleVoting, ThePaperReplacesOutliersAlongTheRatios) {
  auto sessions = sessions_of({10, 10, 10, 10, 100, 10, 10, 10, 10, 10});
  std::vector<Ratio> ratios = equal_units(10);
  ratios[3] = ScaleRatio{2.0, 0.01, 10};
  ratios[4] = ScaleRatio{0.25, 0.01, 10};
  VotedScales voted = vote_scales(sessions, ratios, with(ScaleVoting::kPaper));
  // From before 10 * 2, from behind 10 / 0.25: equally near, the geometric mean.
  EXPECT_NEAR(voted.scales[4], std::sqrt(20.0 * 40.0), 1e-9);
  ratios[3].reset();
  voted = vote_scales(sessions, ratios, with(ScaleVoting::kPaper));
  EXPECT_NEAR(voted.scales[4], 40.0, 1e-9);
  ratios[4].reset();
  voted = vote_scales(sessions, ratios, with(ScaleVoting::kPaper));
  EXPECT_NEAR(voted.scales[4], 100.0, 1e-9);
  EXPECT_THAT(voted.warnings.at(0), HasSubstr("session 4: outvoted, and linked to no inlier"));
}

TEST(ScaleVoting, ThePapersDrawsAreSeeded) {
  std::mt19937_64 random(1);
  std::vector<double> scales;
  for (int i = 0; i < 40; ++i) scales.push_back(test::uniform_in(random, 10, 40));
  ScaleVotingOptions options = with(ScaleVoting::kPaper);
  options.draws = 3;
  const VotedScales a = vote_scales(sessions_of(scales), equal_units(40), options);
  const VotedScales b = vote_scales(sessions_of(scales), equal_units(40), options);
  EXPECT_EQ(a.winner, b.winner);
  EXPECT_EQ(a.scales, b.scales);
  std::vector<std::size_t> winners;
  for (options.seed = 0; options.seed < 20; ++options.seed) {
    winners.push_back(vote_scales(sessions_of(scales), equal_units(40), options).winner);
  }
  EXPECT_GT(std::set<std::size_t>(winners.begin(), winners.end()).size(), 1u) << "three draws of 40 differ by seed";
}

TEST(ScaleVoting, WeightsAreTheSoftmaxOfLinearity) {
  auto sessions = sessions_of({20, 21, 19, 25, 20.5});
  for (std::size_t k = 0; k < 5; ++k) sessions[k].linearity = 0.5 + 0.1 * static_cast<double>(k);
  const VotedScales voted = vote_scales(sessions, equal_units(5), with(ScaleVoting::kPaper));
  double sum = 0.0;
  for (std::size_t k = 0; k < 5; ++k) sum += std::exp(voted.alpha * sessions[k].linearity);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(voted.weights[k], std::exp(voted.alpha * sessions[k].linearity) / sum, 1e-12);
  }
}

TEST(ScaleVoting, TwoSessionsKeepTheMoreCertain) {
  auto sessions = sessions_of({20, 30});
  sessions[1].sigma_log = 0.05;
  VotedScales voted = vote_scales(sessions, equal_units(2));
  EXPECT_THAT(voted.is_inlier, ElementsAre(1, 0));
  EXPECT_NEAR(voted.scales[1], 20.0, 1e-9);
  sessions[0].sigma_log = 0.1;
  voted = vote_scales(sessions, equal_units(2));
  EXPECT_THAT(voted.is_inlier, ElementsAre(0, 1));
  EXPECT_NEAR(voted.scales[0], 30.0, 1e-9);
  // In the paper a pair is exactly two deviations apart, and not parted.
  voted = vote_scales(sessions, equal_units(2), with(ScaleVoting::kPaper));
  EXPECT_THAT(voted.is_inlier, ElementsAre(1, 1));
  EXPECT_THAT(voted.scales, ElementsAre(20.0, 30.0));
}

TEST(ScaleVoting, UnitsMayTrulyDiffer) {
  // Every call has its own unit; the overlaps know it, and one registration is 15 % off.
  std::mt19937_64 random(2);
  std::vector<double> truth{20};
  std::vector<double> ratios;
  for (int k = 1; k < 12; ++k) {
    ratios.push_back(test::uniform_in(random, 0.6, 1.6));
    truth.push_back(truth.back() * ratios.back());
  }
  std::vector<double> measured = truth;
  for (double& s : measured) s *= 1.0 + 0.003 * test::normal(random);
  measured[7] = 1.15 * truth[7];
  const VotedScales voted = vote_scales(sessions_of(measured), ratios_of(ratios));
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_EQ(voted.is_inlier[k], k == 7 ? 0 : 1) << k;
    EXPECT_NEAR(voted.scales[k] / truth[k], 1.0, 0.006) << "two deviations of a single registration";
  }
  // The paper's plain scales differ by more than that, and the wrong one passes.
  const VotedScales paper = vote_scales(sessions_of(measured), ratios_of(ratios), with(ScaleVoting::kPaper));
  EXPECT_EQ(paper.is_inlier[7], 1);
  EXPECT_NEAR(paper.scales[7] / truth[7], 1.15, 1e-9);
}

TEST(ScaleVoting, TwoAgreeAmongManyThatDoNot) {
  // So many outliers that the median deviation lets everyone pass: the correction still finds the pair.
  const VotedScales voted = vote_scales(sessions_of({31, 20, 45, 20.05, 70, 12}), equal_units(6));
  for (const double s : voted.scales) EXPECT_NEAR(s, 20.0, 0.2);
}

TEST(ScaleVoting, SessionsWithoutBaselineTakeTheirNeighbors) {
  auto sessions = sessions_of({20, 1, 20.1, 20.05, 1});
  sessions[1].is_usable = sessions[4].is_usable = false;
  sessions[1].sigma_log = sessions[4].sigma_log = INFINITY;
  for (const ScaleVoting mode : kModes) {
    const VotedScales voted = vote_scales(sessions, ratios_of({0.5, 2.0, 1.0, 3.0}), with(mode));
    EXPECT_THAT(voted.is_inlier, ElementsAre(1, 0, 1, 1, 0));
    EXPECT_NEAR(voted.scales[1], 10.0, 0.1);
    EXPECT_NEAR(voted.scales[4], 60.0, 0.5);
    EXPECT_TRUE(std::isnan(voted.compared[1]));
    // Without overlap there is only the median.
    std::vector<Ratio> cut = ratios_of({0.5, 2.0, 1.0, 3.0});
    cut[3].reset();
    const VotedScales alone = vote_scales(sessions, cut, with(mode));
    EXPECT_NEAR(alone.scales[4], 20.05, 1e-9);
    EXPECT_THAT(alone.warnings.back(), HasSubstr("session 4: no baseline, and linked to no usable session"));
  }
  for (auto& s : sessions) s.is_usable = false;
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { vote_scales(sessions, equal_units(5)); }),
              HasSubstr("no session has a baseline"));
}

TEST(ScaleVoting, WithoutOverlap) {
  // Units may differ a little between calls: 10 % is tolerated, 50 % is not; nobody is changed.
  const VotedScales voted = vote_scales(sessions_of({20, 22, 21, 20.5, 31}), std::vector<Ratio>(4));
  EXPECT_THAT(voted.is_inlier, ElementsAre(1, 1, 1, 1, 0));
  EXPECT_GE(voted.tolerance, std::log(1.2));
  const std::vector<double> kept{20, 22, 21, 20.5, 31};
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(voted.scales[k], kept[k], 1e-9);
  ASSERT_EQ(voted.warnings.size(), 2u);
  EXPECT_THAT(voted.warnings[0], HasSubstr("do not overlap"));
  EXPECT_THAT(voted.warnings[1], HasSubstr("session 4: outvoted, and linked to no inlier: it keeps its own scale"));
}

TEST(ScaleVoting, AnyUnitOfLength) {
  const auto sessions = sessions_of({20, 20.3, 19.8, 23, 20.1, 33});
  auto scaled = sessions;
  for (auto& s : scaled) s.scale *= 1000.0;
  for (const ScaleVoting mode : kModes) {
    const VotedScales a = vote_scales(sessions, equal_units(6), with(mode));
    const VotedScales b = vote_scales(scaled, equal_units(6), with(mode));
    EXPECT_EQ(a.is_inlier, b.is_inlier);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(b.scales[k], 1000.0 * a.scales[k], 1e-6);
  }
}

ScaleChain random_chain(std::mt19937_64& random, std::size_t n) {
  ScaleChain chain;
  for (std::size_t k = 0; k < n; ++k) {
    chain.z.push_back(test::uniform_in(random, -0.2, 0.2));
    chain.a.push_back(k == 1 ? 0.0 : std::pow(10.0, test::uniform_in(random, 2.0, 4.6)));
    if (k + 1 == n) break;
    chain.log_r.push_back(test::uniform_in(random, -0.05, 0.05));
    chain.b.push_back(std::pow(10.0, test::uniform_in(random, 3.0, 4.3)));
  }
  return chain;
}

TEST(ScaleCorrection, LeastSquaresByHand) {
  // Width so large that the cost is quadratic: (x0 - 0)^2 + (x1 - 1)^2 + (x1 - x0 - 0)^2: x0 = 1/3, x1 = 2/3.
  const std::vector<double> x = corrected_log_scales({{0, 1}, {1, 1}, {0}, {1}, 1e8});
  EXPECT_NEAR(x[0], 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(x[1], 2.0 / 3.0, 1e-12);
}

TEST(ScaleCorrection, NoPerturbationHasALowerCost) {
  std::mt19937_64 random(3);
  for (int chain_index = 0; chain_index < 20; ++chain_index) {
    const ScaleChain chain = random_chain(random, 8);
    const std::vector<double> x = corrected_log_scales(chain);
    const double lowest = chain_cost(chain, x);
    for (int trial = 0; trial < 2000; ++trial) {
      const double size = std::pow(10.0, test::uniform_in(random, -7.0, -2.5));
      std::vector<double> other = x;
      for (double& value : other) value += size * test::uniform_in(random, -1, 1);
      ASSERT_GE(chain_cost(chain, other), lowest * (1.0 - 1e-12));
    }
  }
}

TEST(ScaleCorrection, TheLowestMinimumOfAGrid) {
  // Three sessions: every x of a fine grid is tried.
  std::mt19937_64 random(4);
  for (int chain_index = 0; chain_index < 5; ++chain_index) {
    const ScaleChain chain = random_chain(random, 3);
    double lowest = std::numeric_limits<double>::infinity();
    for (int i = -60; i <= 60; ++i) {
      for (int j = -60; j <= 60; ++j) {
        for (int k = -60; k <= 60; ++k) {
          const std::vector<double> x{0.005 * i, 0.005 * j, 0.005 * k};
          lowest = std::min(lowest, chain_cost(chain, x));
        }
      }
    }
    EXPECT_LE(chain_cost(chain, corrected_log_scales(chain)), lowest);
  }
}

TEST(ScaleVoting, RefusesWrongArguments) {
  EXPECT_THROW(vote_scales(sessions_of({1, 2}), {}), std::invalid_argument);
  EXPECT_THROW(vote_scales(sessions_of({1, -2}), equal_units(2)), std::invalid_argument);
  EXPECT_THROW(vote_scales(sessions_of({1, NAN}), equal_units(2)), std::invalid_argument);
  EXPECT_THROW(vote_scales(sessions_of({1, 2}), ratios_of({0.0})), std::invalid_argument);
  ScaleVotingOptions options;
  options.least_tolerance = 1.0;
  EXPECT_THROW(vote_scales(sessions_of({1, 2}), equal_units(2), options), UsageError);
  EXPECT_EQ(test::refusal_of<UnsupportedError>([&] { vote_scales({}, {}); }),
            "no session has a baseline: the scale is not determined");
}

}  // namespace scale_voting_test
}  // namespace cmap
