#include "cmap/recon/registration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "spatial/clouds.hpp"

namespace cmap {
namespace registration_test {

void add_wall(PointCloud& cloud, const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
              double step_m) {
  const auto n_u = static_cast<int>(u.norm() / step_m), n_v = static_cast<int>(v.norm() / step_m);
  for (int i = 0; i <= n_u; ++i) {
    for (int j = 0; j <= n_v; ++j) {
      cloud.positions.push_back((corner + u * i / n_u + v * j / n_v).cast<float>());
    }
  }
}

/// Ground and the walls of a yard of 30 x 20 m, with a wall across that holds every direction.
PointCloud yard(double step_m) {
  PointCloud cloud;
  add_wall(cloud, {0, 0, 0}, {30, 0, 0}, {0, 20, 0}, step_m);
  add_wall(cloud, {0, 0, 0}, {30, 0, 0}, {0, 0, 6}, step_m);
  add_wall(cloud, {30, 0, 0}, {0, 20, 0}, {0, 0, 6}, step_m);
  add_wall(cloud, {12, 20, 0}, {18, 0, 0}, {0, 0, 6}, step_m);
  add_wall(cloud, {10, 8, 0}, {3, 5, 0}, {0, 0, 4}, step_m);
  return cloud;
}

RegistrationOptions by(SessionRegistrationMethod method, double voxel_m) {
  RegistrationOptions options;
  options.method = method;
  options.voxel_m = voxel_m;
  return options;
}

SessionCloud session_of(const PointCloud& cloud) { return {cloud, Array<float>(cloud.size(), 2.0f)}; }

Similarity similarity(double scale, const Eigen::Vector3d& translation, double yaw_rad) {
  Similarity T;
  T.scale = scale;
  T.rotation = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation = translation;
  return T;
}

/// A session 1 % too large, turned by half a degree and 10 cm off. Points a meter apart in a volume: every point finds
/// its own, where walls would let themselves slide.
TEST(Registration, RobustFindsTheScale) {
  PointCloud lidar;
  std::mt19937_64 random(3);
  for (int i = 0; i < 3000; ++i) {
    lidar.positions.push_back({30.0f * static_cast<float>(test::uniform(random)),
                               20.0f * static_cast<float>(test::uniform(random)),
                               6.0f * static_cast<float>(test::uniform(random))});
  }
  const Similarity error = similarity(1.01, {0.1, -0.1, 0.05}, 0.009);
  const SessionCloud session = session_of(transformed(lidar, error.matrix()));
  const SessionRegistration found =
      register_session(session, lidar, error, by(SessionRegistrationMethod::kRobust, 0.2), 0.3);
  EXPECT_TRUE(found.accepted);
  // Exact but for the thinning to 0.2 and 0.1 m, which merges a few neighbors, and the last beta of 1e-4.
  EXPECT_NEAR(found.scale_change * 1.01, 1.0, 2e-4);
  EXPECT_NEAR(found.T_world_session.scale, 1.0, 2e-4) << "error undone";
  EXPECT_LT(found.T_world_session.translation.norm(), 0.01);
  EXPECT_GT(found.overlap, 0.99);
}

TEST(Registration, PrefusionMovesNothingAndSaysHowItFits) {
  const Similarity error = similarity(1.0, {0.3, 0, 0}, 0.0);
  const SessionCloud session = session_of(transformed(yard(0.2), error.matrix()));
  const SessionRegistration found =
      register_session(session, yard(0.2), error, by(SessionRegistrationMethod::kPrefusion, 0.2), 0.3);
  EXPECT_EQ(found.scale_change, 1.0);
  EXPECT_EQ(found.T_world_session.translation, error.translation);
  EXPECT_GT(found.rmse_m, 0.0);
  EXPECT_TRUE(found.flags.empty());
}

/// What comes out never fits worse than what went in, however coarse the voxels.
TEST(Registration, RobustNeverFitsWorse) {
  PointCloud corridor;
  add_wall(corridor, {0, 0, 0}, {20, 0, 0}, {0, 2, 0}, 0.1);
  add_wall(corridor, {0, 0, 0}, {20, 0, 0}, {0, 0, 2.5}, 0.1);
  add_wall(corridor, {0, 2, 0}, {20, 0, 0}, {0, 0, 2.5}, 0.1);
  add_wall(corridor, {20, 0, 0}, {0, 2, 0}, {0, 0, 2.5}, 0.1);
  for (const double voxel_m : {0.1, 0.3, 0.6}) {
    const SessionCloud session = session_of(corridor);
    const auto run = [&](SessionRegistrationMethod method) {
      return register_session(session, corridor, {}, by(method, voxel_m), 0.1);
    };
    const SessionRegistration before = run(SessionRegistrationMethod::kPrefusion),
                              after = run(SessionRegistrationMethod::kRobust);
    const auto cost = [&](const SessionRegistration& r) {
      return r.overlap * r.rmse_m * r.rmse_m + (1.0 - r.overlap) * 9.0 * voxel_m * voxel_m;
    };
    EXPECT_LE(cost(after), cost(before)) << voxel_m;
    EXPECT_TRUE(after.accepted || !after.flags.empty()) << voxel_m;
  }
}

TEST(Registration, WithoutLidarOrPointsTheSessionStays) {
  const Similarity T = similarity(3.0, {1, 2, 3}, 0.1);
  const SessionRegistration alone =
      register_session(session_of(yard(1.0)), {}, T, by(SessionRegistrationMethod::kRobust, 0.2), 0.1);
  EXPECT_FALSE(alone.accepted);
  EXPECT_EQ(alone.T_world_session.translation, T.translation);
  EXPECT_EQ(alone.flags.size(), 1u);
  EXPECT_FALSE(register_session({}, yard(1.0), T, by(SessionRegistrationMethod::kRobust, 0.2), 0.1).accepted);
  PointCloud elsewhere = yard(0.2);
  elsewhere.origin << 500, 0, 0;
  const SessionRegistration apart =
      register_session(session_of(yard(0.2)), elsewhere, T, by(SessionRegistrationMethod::kRobust, 0.2), 0.1);
  EXPECT_FALSE(apart.accepted);
  EXPECT_FALSE(apart.flags.empty());
  EXPECT_EQ(apart.T_world_session.translation, T.translation);
}

}  // namespace registration_test
}  // namespace cmap
