#include "registration/in_view.hpp"

#include <gtest/gtest.h>

namespace cmap {
namespace in_view_test {

/// One camera of 20 x 10 pixels, focal length 10, at the session's origin; its farthest depth 5 units of 2 m: it sees
/// 11 m far, to 12 pixels beside its center at (9.5, 4.5) on the longer axis.
SessionPredictions session() {
  SessionPredictions s;
  s.width = 20;
  s.height = 10;
  s.frames.resize(1);
  s.depth.resize(200, 1.0f);
  s.depth[7] = 5.0f;
  s.T_camera_session = {Eigen::Isometry3d::Identity()};
  s.intrinsics = {(Eigen::Matrix3d() << 10, 0, 9.5, 0, 10, 4.5, 0, 0, 1).finished()};
  return s;
}

TEST(InView, KeepsWhatTheCameraLooksAt) {
  Similarity T_world_session;
  T_world_session.scale = 2.0;
  T_world_session.translation = {100.0, 0.0, 0.0};
  PointCloud cloud;
  cloud.origin = {100.0, 0.0, 0.0};
  cloud.positions = {{0, 0, 4}, {0, 0, -4}, {0, 0, 10.9f}, {0, 0, 11.1f}, {4.9f, 0, 4}, {5.1f, 0, 4}, {0, 2.5f, 4}};
  const PointCloud seen = in_view(cloud, session(), T_world_session);
  // Right edge: u = 10 x / z + 9.5 below 22, so x below 5 at z = 4; lower edge: v = 10 y / z + 4.5 below 11, y
  // below 2.6.
  const std::vector<Eigen::Vector3f> expected{{0, 0, 4}, {0, 0, 10.9f}, {4.9f, 0, 4}, {0, 2.5f, 4}};
  ASSERT_EQ(seen.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(seen.positions[i], expected[i]);
}

}  // namespace in_view_test
}  // namespace cmap
