#include "cmap/gl/orbit_camera.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

namespace cmap {
namespace orbit_camera_test {

Camera from_south(double distance_m) {
  Camera camera;
  camera.target = {10, 20, 30};
  camera.position = camera.target - distance_m * Eigen::Vector3d::UnitY();
  return camera;
}

Eigen::Vector2d pixel_of(const Camera& camera, const Eigen::Vector3d& p) {
  const Projection projection(camera, 400, 200);
  const Eigen::Vector3d d = projection.axes * (p - projection.position);
  return projection.focal_px * d.head<2>() / (camera.orthographic ? 1.0 : d.z());
}

TEST(OrbitCamera, BeginsWhereTheCameraIs) {
  const Camera start = from_south(5.0);
  const OrbitCamera orbit(start);
  EXPECT_TRUE(orbit.camera().position.isApprox(start.position));
  EXPECT_TRUE(orbit.camera().up.isApprox(Eigen::Vector3d::UnitZ()));
}

TEST(OrbitCamera, KeepsTheNorthOfAViewFromAbove) {
  Camera above;
  above.target = {1, 2, 3};
  above.position = {1, 2, 50};
  above.up = Eigen::Vector3d(1, 2, 0).normalized();
  const OrbitCamera orbit(above);
  EXPECT_TRUE(orbit.camera().up.isApprox(above.up, 1e-9));
  EXPECT_TRUE(orbit.camera().position.isApprox(above.position, 1e-9));
}

TEST(OrbitCamera, TurnsAboutTheTargetAndStopsAtThePoles) {
  OrbitCamera orbit(from_south(5.0));
  orbit.turn(90.0, 0.0);
  EXPECT_TRUE(orbit.camera().position.isApprox(Eigen::Vector3d(15, 20, 30), 1e-9)) << "from the east";
  orbit.turn(0.0, 200.0);
  EXPECT_TRUE(orbit.camera().position.isApprox(Eigen::Vector3d(10, 20, 35), 1e-9)) << "from above";
  EXPECT_NEAR(orbit.camera().up.dot(-Eigen::Vector3d::UnitX()), 1.0, 1e-9) << "where one came from is below";
}

TEST(OrbitCamera, HorizonsAreLevel) {
  Camera rolled = from_south(5.0);
  rolled.up = {1, 0, 1};
  EXPECT_TRUE(OrbitCamera(rolled).camera().up.isApprox(Eigen::Vector3d::UnitZ()));
}

TEST(OrbitCamera, PansByPixels) {
  for (const bool orthographic : {false, true}) {
    Camera camera = from_south(5.0);
    camera.orthographic = orthographic;
    camera.view_height_m = 4.0;
    OrbitCamera orbit(camera);
    orbit.turn(20.0, 30.0);
    orbit.pan(7.0, -3.0, 200);
    EXPECT_TRUE(pixel_of(orbit.camera(), camera.target).isApprox(Eigen::Vector2d(7, -3), 1e-6)) << orthographic;
  }
}

TEST(OrbitCamera, ZoomsByAFactorInEitherProjection) {
  Camera camera = from_south(5.0);
  camera.view_height_m = 4.0;
  for (const bool orthographic : {false, true}) {
    camera.orthographic = orthographic;
    OrbitCamera orbit(camera);
    const Eigen::Vector3d beside = camera.target + Eigen::Vector3d(0.5, 0, 0);
    const double before = pixel_of(orbit.camera(), beside).x();
    orbit.zoom(2.0);
    EXPECT_NEAR(pixel_of(orbit.camera(), beside).x(), 2.0 * before, 1e-6);
    orbit.toggle_projection();
    EXPECT_NEAR(pixel_of(orbit.camera(), beside).x(), 2.0 * before, 1e-6) << "the other projection is as large";
  }
}

TEST(OrbitCamera, LooksAtAPoint) {
  OrbitCamera orbit(from_south(5.0));
  orbit.look_at({0, 0, 0});
  EXPECT_TRUE(orbit.camera().position.isApprox(Eigen::Vector3d(0, -5, 0), 1e-9));
}

}  // namespace orbit_camera_test
}  // namespace cmap
