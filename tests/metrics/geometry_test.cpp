#include "cmap/metrics/geometry.hpp"

#include <cmath>

#include "metrics/map_pairs.hpp"

namespace cmap {
namespace {

constexpr double kTruncation_m = 1.0;
const std::vector<double> kThresholds_m{0.5, 0.25, 0.1};

/// The statistics of both directions, as an evaluation takes them.
struct Directions {
  explicit Directions(const test::Clouds& clouds, double scale = 1.0) {
    std::vector<double> thresholds = kThresholds_m;
    for (double& t : thresholds) t *= scale;
    const MapPair pair = clouds.pair();
    estimate = distance_stats(pair.nearest_in_reference.sq_dist, thresholds, scale * kTruncation_m);
    reference = distance_stats(pair.nearest_in_estimate.sq_dist, thresholds, scale * kTruncation_m);
  }
  Chamfer chamfer() const { return cmap::chamfer(estimate, reference); }
  double f_score(std::size_t t) const { return cmap::f_score(estimate.share_within(t), reference.share_within(t)); }

  DistanceStats estimate;
  DistanceStats reference;
};

void expect_same_scores(const Directions& found, const Directions& expected, double tolerance, double scale = 1.0) {
  const Chamfer a = found.chamfer();
  const Chamfer b = expected.chamfer();
  EXPECT_NEAR_RELATIVE(a.l1_sum, scale * b.l1_sum, tolerance);
  EXPECT_NEAR_RELATIVE(a.l1_mean, scale * b.l1_mean, tolerance);
  EXPECT_NEAR_RELATIVE(a.l2sq_sum, scale * scale * b.l2sq_sum, tolerance);
  EXPECT_NEAR_RELATIVE(a.l2_rms_mean, scale * b.l2_rms_mean, tolerance);
  EXPECT_NEAR_RELATIVE(a.truncated_l1_sum, scale * b.truncated_l1_sum, tolerance);
  EXPECT_NEAR_RELATIVE(found.estimate.max_m, scale * expected.estimate.max_m, tolerance);
  for (std::size_t t = 0; t < kThresholds_m.size(); ++t) {
    EXPECT_NEAR_RELATIVE(found.estimate.within[t].rmse_m, scale * expected.estimate.within[t].rmse_m, tolerance);
    // No distance of this pair lies so close to a threshold that rounding moves it across.
    EXPECT_EQ(found.f_score(t), expected.f_score(t));
  }
}

TEST(Chamfer, HandComputed) {
  // Estimate to reference: 0.25, 3; reference to estimate: 0.25, 3, 5.
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {7, 0, 0}, {7, 8, 0}}),
                            test::cloud_of({{0.25f, 0, 0}, {7, 3, 0}})};
  const Directions d(clouds);
  const Chamfer c = d.chamfer();
  EXPECT_DOUBLE_EQ(c.l1_sum, 3.25 / 2 + 8.25 / 3);
  EXPECT_DOUBLE_EQ(c.l1_mean, 0.5 * (3.25 / 2 + 8.25 / 3));
  EXPECT_DOUBLE_EQ(c.l2sq_sum, 9.0625 / 2 + 34.0625 / 3);
  EXPECT_DOUBLE_EQ(c.l2_rms_mean, 0.5 * (std::sqrt(9.0625 / 2) + std::sqrt(34.0625 / 3)));
  EXPECT_DOUBLE_EQ(c.truncated_l1_sum, 1.25 / 2 + 2.25 / 3);
  EXPECT_DOUBLE_EQ(d.f_score(1), 0.4);  // precision 1/2, recall 1/3
}

TEST(Chamfer, EqualsTheDefinition) {
  const test::Clouds clouds = test::two_sheets();
  double sum[2] = {0, 0}, sum_sq[2] = {0, 0};
  const auto nearest_in_reference = test::nearest_by_definition(clouds.estimate, clouds.reference);
  const auto nearest_in_estimate = test::nearest_by_definition(clouds.reference, clouds.estimate);
  for (const auto& n : nearest_in_reference) sum[0] += n.distance_m, sum_sq[0] += n.distance_m * n.distance_m;
  for (const auto& n : nearest_in_estimate) sum[1] += n.distance_m, sum_sq[1] += n.distance_m * n.distance_m;
  const auto n_estimate = static_cast<double>(clouds.estimate.size());
  const auto n_reference = static_cast<double>(clouds.reference.size());
  const Chamfer c = Directions(clouds).chamfer();
  EXPECT_NEAR_RELATIVE(c.l1_sum, sum[0] / n_estimate + sum[1] / n_reference, test::kSummation);
  EXPECT_NEAR_RELATIVE(c.l2sq_sum, sum_sq[0] / n_estimate + sum_sq[1] / n_reference, test::kSummation);
}

TEST(Chamfer, OfAMapAndItselfIsZero) {
  for (const PointCloud& cloud : {test::two_sheets().reference, test::painted_triplicates(300)}) {
    const Directions same({cloud, cloud});
    EXPECT_EQ(same.chamfer().l1_sum, 0.0);
    EXPECT_EQ(same.chamfer().l2sq_sum, 0.0);
    EXPECT_EQ(same.chamfer().truncated_l1_sum, 0.0);
    for (std::size_t t = 0; t < kThresholds_m.size(); ++t) EXPECT_EQ(same.f_score(t), 1.0);
  }
}

TEST(Chamfer, IsSymmetric) {
  const test::Clouds clouds = test::two_sheets();
  const Directions one(clouds);
  const Directions other({clouds.estimate, clouds.reference});
  EXPECT_EQ(one.chamfer().l1_sum, other.chamfer().l1_sum);
  EXPECT_EQ(one.f_score(0), other.f_score(0));
  EXPECT_NE(one.estimate.mean_m, other.estimate.mean_m);  // its parts are not
}

TEST(Geometry, IsInvariantUnderARigidMotion) {
  const test::Clouds clouds = test::two_sheets();
  expect_same_scores(Directions(test::moved(clouds, test::rigid_motion())), Directions(clouds), test::kMoved);
}

TEST(Geometry, IsInvariantUnderPermutation) {
  const test::Clouds clouds = test::two_sheets();
  expect_same_scores(Directions(test::permuted(clouds)), Directions(clouds), test::kSummation);
}

TEST(Geometry, IsInvariantUnderATranslationByAMillionMeters) {
  const test::Clouds clouds = test::two_sheets();
  const test::Clouds far = test::moved(clouds, test::translation({1e6, -1e6, 1e6}));
  ASSERT_GT(bounds(far.reference).min.x(), 9e5);
  // Round shifts leave the offsets as they were.
  expect_same_scores(Directions(far), Directions(clouds), test::kSummation);
  const test::Clouds odd = test::moved(clouds, test::translation({1e6 / 3, -1e6 / 7, 1e6}));
  expect_same_scores(Directions(odd), Directions(clouds), test::kMoved);
}

TEST(Geometry, ScalesWithTheMaps) {
  const test::Clouds clouds = test::two_sheets();
  expect_same_scores(Directions(test::moved(clouds, test::scaling(4.0)), 4.0), Directions(clouds), test::kSummation,
                     4.0);
  expect_same_scores(Directions(test::moved(clouds, test::scaling(0.3)), 0.3), Directions(clouds), test::kMoved, 0.3);
}

TEST(FScore, HandComputed) {
  EXPECT_EQ(f_score(0.0, 0.0), 0.0);
  EXPECT_EQ(f_score(1.0, 0.0), 0.0);
  EXPECT_EQ(f_score(1.0, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(f_score(1.0, 2.0 / 3.0), 0.8);
  EXPECT_EQ(f_score(0.25, 0.75), 0.375);
}

TEST(FScore, LiesBetweenBothAndRisesWithEach) {
  for (double p = 0.05; p < 1.0; p += 0.1) {
    for (double r = 0.05; r < 1.0; r += 0.1) {
      EXPECT_EQ(f_score(p, r), f_score(r, p));
      // A harmonic mean of equal numbers may round past them by one digit.
      EXPECT_GE(f_score(p, r), std::min(p, r) * (1.0 - 1e-15));
      EXPECT_LE(f_score(p, r), std::max(p, r) * (1.0 + 1e-15));
      EXPECT_GT(f_score(p + 0.01, r), f_score(p, r));
    }
  }
}

}  // namespace
}  // namespace cmap
