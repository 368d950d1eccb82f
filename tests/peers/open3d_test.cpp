#include "cmap/peers/open3d.hpp"

#include <cmath>

#include "peers/peers_testing.hpp"

namespace cmap {
namespace open3d_test {

using test::Doubles;

TEST(Open3dRegistration, HandComputed) {
  const Doubles sq_dist{0.0, 0.25, 1.0, 4.0};
  const Open3dRegistration found = open3d_registration(sq_dist, 1.0);  // below, not at the threshold
  EXPECT_EQ(found.n_correspondences, 2U);
  EXPECT_EQ(found.fitness, 0.5);
  EXPECT_DOUBLE_EQ(found.inlier_rmse_m, std::sqrt(0.125));
  EXPECT_EQ(open3d_registration(sq_dist, 100.0).fitness, 1.0);
}

TEST(Open3dRegistration, WithoutInliersIsZeroLikeTheTool) {
  const Open3dRegistration none = open3d_registration(Doubles{1.0, 2.0}, 1.0);
  EXPECT_EQ(none.n_correspondences, 0U);
  EXPECT_EQ(none.fitness, 0.0);
  EXPECT_EQ(none.inlier_rmse_m, 0.0);
}

TEST(Open3dRegistration, IsOursWhereNoDistanceIsTheThreshold) {
  const Doubles sq_dist = test::peer_squares(5000);
  for (double threshold_m : {0.05, 0.1, 0.7}) {
    const Open3dRegistration theirs = open3d_registration(sq_dist, threshold_m);
    const MapPair pair = test::pair_with(Array<double>(sq_dist.begin(), sq_dist.end()));
    const MetricOptions options = test::with_thresholds({threshold_m});
    EXPECT_EQ(theirs.fitness, *test::at_threshold(test::measured(catalog::fitness, pair, options), 0).value);
    EXPECT_NEAR_RELATIVE(theirs.inlier_rmse_m,
                         *test::at_threshold(test::measured(catalog::accuracy, pair, options), 0).value,
                         test::kSummation);
  }
}

}  // namespace open3d_test
}  // namespace cmap
