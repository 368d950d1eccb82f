#include <cmath>

#include "cmap/core/execution.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace chamfer_test {

using test::measured;
using test::number;

Record chamfer(const test::Clouds& clouds, double overlap_distance_m = 1.0) {
  return measured(catalog::chamfer, clouds, test::with_thresholds({0.1}, overlap_distance_m));
}

constexpr const char* kVariants[]{"l1_sum", "l1_mean", "l2sq_sum", "l2_rms_mean", "truncated_l1_sum"};

TEST(Chamfer, HandComputed) {
  // Estimate to reference: 0.25, 3; reference to estimate: 0.25, 3, 5.
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {7, 0, 0}, {7, 8, 0}}),
                            test::cloud_of({{0.25f, 0, 0}, {7, 3, 0}})};
  const Record found = chamfer(clouds);
  EXPECT_DOUBLE_EQ(*found.value, 3.25 / 2 + 8.25 / 3);
  EXPECT_DOUBLE_EQ(number(found, "estimate_to_reference"), 3.25 / 2);
  EXPECT_DOUBLE_EQ(number(found, "reference_to_estimate"), 8.25 / 3);
  EXPECT_EQ(number(found, "n_estimate"), 2);
  EXPECT_EQ(number(found, "n_reference"), 3);
  EXPECT_EQ(number(found, "variants.l1_sum"), *found.value);
  EXPECT_DOUBLE_EQ(number(found, "variants.l1_mean"), 0.5 * (3.25 / 2 + 8.25 / 3));
  EXPECT_DOUBLE_EQ(number(found, "variants.l2sq_sum"), 9.0625 / 2 + 34.0625 / 3);
  EXPECT_DOUBLE_EQ(number(found, "variants.l2_rms_mean"), 0.5 * (std::sqrt(9.0625 / 2) + std::sqrt(34.0625 / 3)));
  EXPECT_DOUBLE_EQ(number(found, "variants.truncated_l1_sum"), 1.25 / 2 + 2.25 / 3);
}

TEST(Chamfer, EqualsTheDefinition) {
  const test::Clouds clouds = test::two_sheets();
  double sum[2] = {0, 0}, sum_sq[2] = {0, 0};
  for (const auto& n : test::nearest_by_definition(clouds.estimate, clouds.reference)) {
    sum[0] += n.distance_m, sum_sq[0] += n.distance_m * n.distance_m;
  }
  for (const auto& n : test::nearest_by_definition(clouds.reference, clouds.estimate)) {
    sum[1] += n.distance_m, sum_sq[1] += n.distance_m * n.distance_m;
  }
  const auto n_estimate = static_cast<double>(clouds.estimate.size());
  const auto n_reference = static_cast<double>(clouds.reference.size());
  const Record found = chamfer(clouds);
  EXPECT_NEAR_RELATIVE(*found.value, sum[0] / n_estimate + sum[1] / n_reference, test::kSummation);
  EXPECT_NEAR_RELATIVE(number(found, "variants.l2sq_sum"), sum_sq[0] / n_estimate + sum_sq[1] / n_reference,
                       test::kSummation);
}

/// Over many chunks, against a sum of long doubles.
TEST(Chamfer, EqualsTheDefinitionOverManyChunks) {
  const Array<double> sq_dist = test::random_squares(300001, 1);
  long double sum = 0.0L, truncated = 0.0L;
  for (const double sq : sq_dist) {
    sum += std::sqrt(sq);
    truncated += std::min(std::sqrt(sq), 0.3);
  }
  const Record found = measured(catalog::chamfer, test::pair_with(sq_dist), test::with_thresholds({0.1}, 0.3));
  EXPECT_NEAR_RELATIVE(number(found, "estimate_to_reference"), static_cast<double>(sum / 300001.0L),
                       test::kLongDoubleSum);
  EXPECT_NEAR_RELATIVE(number(found, "variants.truncated_l1_sum"), 2.0 * static_cast<double>(truncated / 300001.0L),
                       test::kLongDoubleSum);
}

TEST(Chamfer, OfAMapAndItselfIsZero) {
  for (const PointCloud& cloud : {test::two_sheets().reference, test::painted_triplicates(300)}) {
    const Record same = chamfer({cloud, cloud});
    for (const char* variant : kVariants) EXPECT_EQ(number(same, std::string("variants.") + variant), 0.0);
  }
}

TEST(Chamfer, IsSymmetric) {
  const test::Clouds clouds = test::two_sheets();
  const Record one = chamfer(clouds), other = chamfer({clouds.estimate, clouds.reference});
  EXPECT_EQ(*one.value, *other.value);
  EXPECT_NE(number(one, "estimate_to_reference"), number(one, "reference_to_estimate")) << "its parts are not";
}

void expect_same_variants(const Record& found, const Record& expected, double tolerance, double scale = 1.0) {
  for (const char* variant : kVariants) {
    const std::string path = std::string("variants.") + variant;
    const double factor = path.ends_with("l2sq_sum") ? scale * scale : scale;
    EXPECT_NEAR_RELATIVE(number(found, path), factor * number(expected, path), tolerance) << variant;
  }
}

TEST(Chamfer, IsInvariantUnderMotionPermutationAndTranslation) {
  const test::Clouds clouds = test::two_sheets();
  const Record expected = chamfer(clouds);
  expect_same_variants(chamfer(test::moved(clouds, test::rigid_motion())), expected, test::kMoved);
  expect_same_variants(chamfer(test::permuted(clouds)), expected, 0.0);
  const test::Clouds far = test::moved(clouds, test::translation({1e6, -1e6, 1e6}));
  ASSERT_GT(bounds(far.reference).min.x(), 9e5);
  // Round shifts leave the offsets as they were.
  expect_same_variants(chamfer(far), expected, test::kSummation);
  const test::Clouds odd = test::moved(clouds, test::translation({1e6 / 3, -1e6 / 7, 1e6}));
  expect_same_variants(chamfer(odd), expected, test::kMoved);
}

TEST(Chamfer, ScalesWithTheMaps) {
  const test::Clouds clouds = test::two_sheets();
  const Record expected = chamfer(clouds);
  expect_same_variants(chamfer(test::moved(clouds, test::scaling(4.0)), 4.0), expected, test::kSummation, 4.0);
  expect_same_variants(chamfer(test::moved(clouds, test::scaling(0.3)), 0.3), expected, test::kMoved, 0.3);
}

TEST(Chamfer, SameBitsForAnyNumberOfThreads) {
  const MapPair pair = test::pair_with(test::random_squares(400000, 4));
  const Record many = measured(catalog::chamfer, pair);
  const ExecutionScope limit({.threads = 1});
  expect_same_variants(measured(catalog::chamfer, pair), many, 0.0);
}

}  // namespace chamfer_test
}  // namespace cmap
