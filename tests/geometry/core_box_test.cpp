#include "cmap/geometry/core_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace cmap {
namespace core_box_test {

using Eigen::Vector3d;

/// n points along a line: (i, 2 i, -i) + offset for i = 0 ... n - 1.
std::vector<Vector3d> line(int n, const Vector3d& offset = Vector3d::Zero()) {
  std::vector<Vector3d> points;
  for (int i = 0; i < n; ++i) points.push_back(Vector3d(i, 2 * i, -i) + offset);
  return points;
}

TEST(CoreBox, LeavesOneOfFewPointsOutAtEitherEnd) {
  const Box3d core = core_box(line(10));
  EXPECT_EQ(core.min, Vector3d(1, 2, -8));
  EXPECT_EQ(core.max, Vector3d(8, 16, -1));
}

TEST(CoreBox, LeavesAHundredthOutAtEitherEnd) {
  const Box3d core = core_box(line(300));
  EXPECT_EQ(core.min, Vector3d(3, 6, -296));
  EXPECT_EQ(core.max, Vector3d(296, 592, -3));
}

TEST(CoreBox, NeedsTenPoints) { EXPECT_THROW(core_box(line(9)), std::invalid_argument); }

TEST(CoreBox, DistanceToABox) {
  const Box3d box{Vector3d::Zero(), Vector3d::Ones()};
  EXPECT_EQ(distance_to(box, {0.5, 1, 0}), 0.0);
  EXPECT_EQ(distance_to(box, {-3, 0.5, 5}), 5.0);
}

TEST(CoreBox, ReachOfStrays) {
  EXPECT_EQ(stray_reach_m({Vector3d::Zero(), Vector3d(3, 4, 0)}), 50.0);
  EXPECT_TRUE(std::isinf(stray_reach_m({Vector3d::Ones(), Vector3d::Ones()})));
}

TEST(ChooseOriginOfSample, AStrayDoesNotMoveIt) {
  const Vector3d utm(500000, 4000000, 100);
  std::vector<Vector3d> sample = line(50, utm);
  const auto origin_with = [&](const Vector3d& far) {
    sample.push_back(far);
    const Vector3d origin =
        choose_origin({utm.cwiseMin(far), (utm + Vector3d(49, 98, -49)).cwiseMax(far)}, cloud_core(sample));
    sample.pop_back();
    return origin;
  };
  // The core reaches from 1 to 49 steps of (1, 2, -1) at most: units of 100 m.
  const Vector3d undisturbed(500000, 4000000, 100);
  EXPECT_EQ(origin_with(utm), undisturbed);
  EXPECT_EQ(origin_with(Vector3d::Zero()), undisturbed);
  EXPECT_EQ(origin_with({1e8, 0, 0}), undisturbed);
  // 900 m above, within ten diagonals (of 115 m): it belongs to the map, whose height of 949 m has a unit of 1000 m.
  EXPECT_EQ(origin_with(utm + Vector3d(0, 0, 900)), Vector3d(500000, 4000000, 1000));
}

TEST(ChooseOriginOfSample, FewPointsHaveNoStrays) {
  EXPECT_EQ(choose_origin({Vector3d::Zero(), Vector3d(1e7, 0, 0)}, cloud_core(line(5))),
            choose_origin({Vector3d::Zero(), Vector3d(1e7, 0, 0)}));
}

}  // namespace core_box_test
}  // namespace cmap
