#include <cmath>

#include "cmap/sim/seen_surface.hpp"
#include "sim/sim_testing.hpp"

namespace cmap {
namespace scene_sampling_test {

using ::testing::HasSubstr;
using testing::TempFolder;
using ::testing::ThrowsMessage;

Scene box(const TempFolder& folder) {
  return read_mesh_scene(folder.write("box.obj", testing::box_obj({0, 0, 0}, {2, 3, 4}, "1 0.2 0")));
}

TEST(SampleSurface, IsUniformOverABox) {
  const TempFolder folder;
  const PointCloud cloud = sample_surface(box(folder), 1000.0, 9);
  ASSERT_EQ(52000U, cloud.size());  // 2 (2*3 + 3*4 + 4*2) m^2
  const Eigen::Vector3d size(2, 3, 4);
  std::array<int, 6> on_side{};
  std::array<int, 64> cells{};  // of the side x = 2
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.world(i);
    int sides = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int end = 0; end < 2; ++end) {
        if (std::abs(p[axis] - (end == 0 ? 0.0 : size[axis])) > 1e-6) continue;
        ++sides;
        ++on_side[static_cast<std::size_t>(2 * axis + end)];
      }
      EXPECT_GE(p[axis], -1e-6);
      EXPECT_LE(p[axis], size[axis] + 1e-6);
    }
    EXPECT_GE(sides, 1);
    if (p.x() < 2.0 - 1e-6) continue;
    cells[static_cast<std::size_t>(std::min(7.0, p.y() / 3.0 * 8.0)) * 8 +
          static_cast<std::size_t>(std::min(7.0, p.z() * 2.0))] += 1;
  }
  const std::array<double, 6> expected = {12000, 12000, 8000, 8000, 6000, 6000};
  // The sides follow each other in the order of the area, of which every point has an equal part of its own.
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(expected[i], on_side[i], 2.0);
  double chi_squared = 0.0;
  for (const int n : cells) chi_squared += (n - 187.5) * (n - 187.5) / 187.5;
  EXPECT_LT(chi_squared, 103.4);  // 63 degrees of freedom: exceeded once in a thousand
  EXPECT_GT(chi_squared, 20.0);   // and not suspiciously even
  EXPECT_EQ((Rgb8{255, 51, 0}), std::get<Array<Rgb8>>(cloud.colors)[17]);
}

TEST(SampleSurface, RefusesDensitiesThatMakeNoSense) {
  const TempFolder folder;
  const Scene scene = box(folder);
  EXPECT_THAT([&] { sample_surface(scene, 0.0, 1); }, ThrowsMessage<UsageError>(HasSubstr("points_per_m2 is 0")));
  EXPECT_THAT([&] { sample_surface(scene, std::nan(""), 1); }, ThrowsMessage<UsageError>(HasSubstr("points_per_m2")));
  EXPECT_THAT([&] { sample_surface(scene, 1e12, 1); }, ThrowsMessage<UsageError>(HasSubstr("2^31")));
}

/// A wall 2 m ahead hides half of another one 4 m ahead.
TEST(SeenSurface, IsWhatIsInViewAndNotHidden) {
  const TempFolder folder;
  const Scene scene = read_mesh_scene(folder.write("walls.obj",
                                                   "v -9 2 -9\nv 0 2 -9\nv 0 2 9\nv -9 2 9\n"
                                                   "v -9 4 -9\nv 9 4 -9\nv 9 4 9\nv -9 4 9\nf 1 2 3 4\nf 5 6 7 8\n"));
  const CameraModel camera = testing::pinhole(200, 100, 100.0);
  const std::array<Eigen::Isometry3d, 1> poses = {testing::looking({0, 0, 0}, {0, 1, 0})};
  const PointCloud seen = seen_surface(scene, camera, poses, {.points_per_m2 = 400.0});
  int near = 0, far = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector3d p = seen.world(i);
    // The image spans 200 x 100 pixels of 1/100.
    EXPECT_LE(std::abs(p.x()), p.y() * 1.0 + 1e-6);
    EXPECT_LE(std::abs(p.z()), p.y() * 0.5 + 1e-6);
    if (p.y() < 3.0) {
      ++near;
      EXPECT_LE(p.x(), 1e-6);
    } else {
      ++far;
      EXPECT_GE(p.x(), -1e-6);
    }
  }
  // 2 x 2 m of the near wall and 4 x 4 m of the far one, within 5 sigma of a Poisson count.
  EXPECT_NEAR(400.0 * 2.0 * 2.0, near, 5.0 * 40.0);
  EXPECT_NEAR(400.0 * 4.0 * 4.0, far, 5.0 * 80.0);
  EXPECT_EQ(near, static_cast<int>(
                      seen_surface(scene, camera, poses, {.points_per_m2 = 400.0, .max_distance_m = 3.9}).size()));
  EXPECT_EQ(0U, seen_surface(scene, camera, {}, {}).size());
}

/// Against every point and view by itself, with the scene's own single rays. Some views are out of reach.
TEST(SeenSurface, IsWhatSingleRaysFindFromAnyOfManyViews) {
  const Scene& scene = testing::town();
  const CameraModel camera = testing::pinhole(160, 120, 110.0);
  constexpr double kReach_m = 25.0;
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 7; ++i) poses.push_back(testing::looking({-60.0 + 12.0 * i, -30.0, 1.6}, {1, 0.3 * (i % 3), 0}));
  const PointCloud seen =
      seen_surface(scene, camera, poses, {.points_per_m2 = 0.5, .max_distance_m = kReach_m, .seed = 4});
  const PointCloud all = sample_surface(scene, 0.5, 4);
  std::size_t next = 0, n_seen = 0, n_doubtful = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool found = next < seen.size() && seen.positions[next] == all.positions[i];
    if (found) ++next;
    bool expected = false, doubtful = false;
    for (const Eigen::Isometry3d& pose : poses) {
      const Eigen::Vector3d ray = all.world(i) - pose.translation();
      const auto pixel = project(camera, pose.inverse() * all.world(i));
      if (ray.norm() > kReach_m || !pixel || !is_inside(camera, *pixel)) continue;
      const auto hit = scene.probe(pose.translation(), ray.normalized(), kReach_m + 1.0);
      // What lies between must end 1 cm before the point; within a millimeter of that, floats decide.
      const double gap = hit ? ray.norm() - hit->distance_m : 0.0;
      expected = expected || gap < 0.01;
      doubtful = doubtful || std::abs(gap - 0.01) < 1e-3;
    }
    if (doubtful) {
      ++n_doubtful;
      continue;
    }
    EXPECT_EQ(found, expected) << "point " << i;
    n_seen += expected ? 1 : 0;
  }
  EXPECT_EQ(next, seen.size()) << "in the order of sample_surface()";
  EXPECT_GT(n_seen, 200U);
  EXPECT_LT(n_doubtful, n_seen / 20);
}

}  // namespace scene_sampling_test
}  // namespace cmap
