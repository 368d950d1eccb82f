#include "align/align_testing.hpp"
#include "cmap/align/align.hpp"

namespace cmap {
namespace plane_test {

/// Walls across x, y and z that do not touch.
PointCloud three_walls(std::size_t n) {
  PointCloud cloud = test::uniform_cloud(n, 1, 4.0f);
  for (std::size_t i = 0; i < n; ++i) {
    cloud.positions[i] += Eigen::Vector3f::Ones();
    cloud.positions[i][static_cast<Eigen::Index>(i % 3)] = 0.0f;
  }
  return cloud;
}

/// Between flat walls the distance is linear in the shift, wherever on its wall the nearest point lies: the first step
/// is exact, and a second one on the first level and one on each of the other two find nothing to do.
TEST(Plane, OneStepFindsAShiftOfFlatWalls) {
  const PointCloud target = three_walls(3000);
  const Similarity T{1.0, Eigen::Matrix3d::Identity(), {0.2, -0.1, 0.3}};
  const PointCloud source = transformed(target, T.inverse().matrix());
  AlignOptions options;
  options.max_distance_m = 1.0;
  constexpr double kVoxel = 1e-3;  // joins no points
  const Alignment plane = registration_method("plane").run(source, target, options, kVoxel);
  EXPECT_EQ(plane.iterations, 2 + 1 + 1);
  EXPECT_TRUE(plane.converged);
  // Coordinates of 5 m are rounded to 2^-22 m.
  EXPECT_LT(test::displacement_m(similarity_from(plane.T_dst_src), T, source), 1e-6);
  EXPECT_GT(registration_method("icp").run(source, target, options, kVoxel).iterations, plane.iterations)
      << "points hold each other along the walls";
}

}  // namespace plane_test
}  // namespace cmap
