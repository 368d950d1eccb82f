#include "align/align_testing.hpp"
#include "align/towns.hpp"
#include "cmap/align/align.hpp"

namespace cmap {
namespace sim3_test {

using ::testing::StartsWith;

/// sim3_icp() keeps some 1e-3 of a scale from its start (sim3_icp_test.cpp); the surfaces that it settles on do not.
TEST(Sim3, SettlesTheScaleUnasked) {
  const PointCloud target = test::town(40, 30000, 1);
  const Similarity T{1.02, rotation_from({0, 0, 0.01}), {0.2, -0.1, 0.1}};
  const Alignment found = align(transformed(target, T.inverse().matrix()), target, registration_method("sim3"));
  EXPECT_EQ(found.method, "sim3");
  // A copy: the points themselves meet, to the rounding of coordinates of 40 m, 2^-19 m.
  EXPECT_NEAR(found.scale, 1.02, 1e-6);
}

/// Who asks for an alignment has no use for the start that sim3_icp() keeps.
TEST(Sim3, RefusesWhereTheStartWouldBeKept) {
  const PointCloud cloud = test::town(20, 3000, 2);
  PointCloud far = cloud;
  far.origin.z() += 1000.0;
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { align(far, cloud, registration_method("sim3")); }),
              StartsWith("no overlap"));
}

}  // namespace sim3_test
}  // namespace cmap
