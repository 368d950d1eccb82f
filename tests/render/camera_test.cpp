#include "cmap/render/camera.hpp"

#include <fmt/format.h>

#include <fstream>

#include "cmap/render/turntable.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace camera_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Pixel of a world point, by the formula in the header.
Eigen::Vector2d pixel_of(const Projection& projection, const Eigen::Vector3d& p) {
  const Eigen::Vector3d d = projection.axes * (p - projection.position);
  const double w = projection.orthographic ? 1.0 : d.z();
  return Eigen::Vector2d(projection.width_px, projection.height_px) / 2.0 + projection.focal_px * d.head<2>() / w;
}

TEST(Projection, RightIsRightAndUpIsUp) {
  Camera camera;
  camera.position = {0, -10, 0};
  camera.target = {0, 0, 0};
  camera.field_of_view_deg = 90.0;  // 100 pixels above and below the middle at as much tangent
  const Projection projection(camera, 400, 200);
  EXPECT_NEAR(projection.focal_px, 100.0, 1e-9);
  EXPECT_TRUE(pixel_of(projection, {0, 0, 0}).isApprox(Eigen::Vector2d(200, 100)));
  EXPECT_TRUE(pixel_of(projection, {5, 0, 0}).isApprox(Eigen::Vector2d(250, 100)));
  EXPECT_TRUE(pixel_of(projection, {0, 0, 5}).isApprox(Eigen::Vector2d(200, 50)));
  EXPECT_NEAR(projection.meters_per_pixel(10.0), 0.1, 1e-12);
}

class EveryView : public ::testing::TestWithParam<std::tuple<const char*, bool>> {};

TEST_P(EveryView, ShowsTheWholeMapAndFillsThePicture) {
  const auto& [name, orthographic] = GetParam();
  const PointBlocks points = sort_points(test::sheet_cloud(5000, 1));
  const Box3d box = box_to_show(points);
  const Projection projection(camera_for(view_from_name(name), points, 1.6, orthographic), 1600, 1000);
  Eigen::Array2d least(1e9, 1e9), most(-1e9, -1e9);
  for (std::size_t slot = 0; slot < points.size; ++slot) {
    const Eigen::Vector3d p = points.world(slot).cwiseMax(box.min).cwiseMin(box.max);
    const Eigen::Array2d pixel = pixel_of(projection, p).array();
    least = least.min(pixel);
    most = most.max(pixel);
  }
  EXPECT_GE(least.minCoeff(), 0.0);
  EXPECT_LE(most.x(), 1600.0);
  EXPECT_LE(most.y(), 1000.0);
  EXPECT_TRUE(most.x() - least.x() > 0.9 * 1600 || most.y() - least.y() > 0.9 * 1000);
  EXPECT_NEAR((most + least).x() / 2.0, 800.0, 20.0);
  EXPECT_NEAR((most + least).y() / 2.0, 500.0, 20.0);
}

INSTANTIATE_TEST_SUITE_P(Camera, EveryView,
                         ::testing::Combine(::testing::Values("top", "oblique", "front", "side", "fit"),
                                            ::testing::Bool()));

class EveryTurn : public ::testing::TestWithParam<std::tuple<const char*, bool>> {};

TEST_P(EveryTurn, ShowsTheWholeMapFromAllSides) {
  const auto& [name, orthographic] = GetParam();
  PointCloud cloud = test::sheet_cloud(5000, 1);
  for (Eigen::Vector3f& p : cloud.positions) p.x() *= 3.0f;  // a long map far from the origin
  cloud.origin = {1000.0, -500.0, 20.0};
  const PointBlocks points = sort_points(cloud);
  const Box3d box = box_to_show(points);
  const Camera first = turntable_camera_for(view_from_name(name), points, 1.6, orthographic);
  double highest_share = 0.0;
  for (const Camera& camera : turntable_cameras(first, 7)) {  // angles that are not those it was fitted to
    EXPECT_NEAR((camera.position - camera.target).norm(), (first.position - first.target).norm(), 1e-6);
    const Projection projection(camera, 1600, 1000);
    for (std::size_t slot = 0; slot < points.size; ++slot) {
      const Eigen::Array2d pixel = pixel_of(projection, points.world(slot).cwiseMax(box.min).cwiseMin(box.max)).array();
      EXPECT_TRUE((pixel >= 0.0).all() && pixel.x() <= 1600.0 && pixel.y() <= 1000.0);
      highest_share = std::max(highest_share, ((pixel / Eigen::Array2d(1600, 1000)) - 0.5).abs().maxCoeff() * 2.0);
    }
  }
  EXPECT_GT(highest_share, 0.85) << "it fills the picture from some side";
}

INSTANTIATE_TEST_SUITE_P(Camera, EveryTurn,
                         ::testing::Combine(::testing::Values("top", "oblique", "front", "fit"), ::testing::Bool()));

TEST(TurntableCameras, AQuarterTurnByHand) {
  Camera camera;
  camera.position = {3.0, 0.0, 2.0};
  camera.target = {1.0, 0.0, 1.0};
  const std::vector<Camera> cameras = turntable_cameras(camera, 4);
  ASSERT_EQ(cameras.size(), 4u);
  EXPECT_EQ(cameras[0].position, camera.position);
  EXPECT_TRUE(cameras[1].position.isApprox(Eigen::Vector3d(1.0, 2.0, 2.0), 1e-12));
  EXPECT_TRUE(cameras[2].position.isApprox(Eigen::Vector3d(-1.0, 0.0, 2.0), 1e-12));
  EXPECT_EQ(cameras[3].target, camera.target);
}

TEST(BoxToShow, LeavesOutOutliersButNotThePoint) {
  PointCloud cloud = test::uniform_cloud(10'000, 2, 1.0f);
  cloud.positions[7] = {0, 0, 1e6f};
  const Box3d box = box_to_show(sort_points(cloud));
  EXPECT_LT((box.max - box.min).norm(), 10.0);
  const Box3d one = box_to_show(sort_points(test::small_map({{3, 4, 5}})));
  EXPECT_EQ(one.max - one.min, Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(0.5 * (one.max + one.min), Eigen::Vector3d(3, 4, 5));
}

Camera camera_in(const std::string& json) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "camera.json";
  std::ofstream(path) << json;
  return read_camera(path);
}

TEST(ReadCamera, TakesAllKeys) {
  const Camera camera = camera_in(R"({"position_m": [1, 2, 3], "target_m": [4, 5, 6], "up": [0, 1, 0],
                                      "view_height_m": 12.5 /* a comment */})");
  EXPECT_EQ(camera.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(camera.target, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(camera.up, Eigen::Vector3d::UnitY());
  EXPECT_TRUE(camera.orthographic);
  EXPECT_EQ(camera.view_height_m, 12.5);
}

TEST(ReadCamera, TakesTheViewThatOpen3dCopies) {
  const auto view = [](double field_of_view_deg) {
    return camera_in(fmt::format(R"({{"class_name": "ViewTrajectory", "interval": 29, "is_loop": false, "trajectory": [
      {{"boundingbox_max": [10, 4, 2], "boundingbox_min": [0, 0, 0], "field_of_view": {}, "front": [0, -2, 0],
        "lookat": [5, 2, 1], "up": [0, 0, 1], "zoom": 0.5}}], "version_major": 1, "version_minor": 0}})",
                                 field_of_view_deg));
  };
  // 5 m above and below the middle of the picture: half the box's longest edge, at 5 m / tan(30 degrees).
  const Camera perspective = view(60.0);
  EXPECT_FALSE(perspective.orthographic);
  EXPECT_NEAR(perspective.position.y(), 2.0 - 8.660254037844386, 1e-12);
  EXPECT_EQ(perspective.position.x(), 5.0);
  EXPECT_EQ(perspective.target, Eigen::Vector3d(5, 2, 1));
  EXPECT_EQ(perspective.up, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(perspective.field_of_view_deg, 60.0);
  const Camera parallel = view(5.0);
  EXPECT_TRUE(parallel.orthographic);
  EXPECT_EQ(parallel.view_height_m, 10.0);
}

std::string pinhole(const char* extrinsic, double cx_px) {
  return fmt::format(R"({{"class_name": "PinholeCameraParameters", "extrinsic": {}, "intrinsic": {{"width": 1600,
      "height": 1000, "intrinsic_matrix": [500, 0, 0, 0, 500, 0, {}, 499.5, 1]}}, "version_major": 1}})",
                     extrinsic, cx_px);
}

TEST(ReadCamera, TakesOpen3dPinholeParameters) {
  // At (1, 2, 3), along +x, z up: right is -y and down is -z; columns after each other.
  const Camera camera = camera_in(pinhole("[0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0, 2, 3, -1, 1]", 799.5));
  EXPECT_EQ(camera.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(camera.target, Eigen::Vector3d(2, 2, 3));
  EXPECT_EQ(camera.up, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(camera.field_of_view_deg, 90.0, 1e-12) << "500 pixels on either side at a focal length of 500";
}

TEST(ReadCamera, SaysWhatOfOpen3dItCannotUse) {
  const auto refusal = [](const std::string& json) { return test::refusal_of<UsageError>([&] { camera_in(json); }); };
  const char* level = "[0, 0, 1, 0, -1, 0, 0, 0, 0, -1, 0, 0, 2, 3, -1, 1]";
  EXPECT_THAT(refusal(pinhole(level, 600)), HasSubstr("the principal point 600, 499.5 is not in the middle"));
  EXPECT_THAT(refusal(pinhole("[1, 0, 0]", 799.5)), HasSubstr("extrinsic: expected 16 numbers"));
  EXPECT_THAT(refusal(pinhole("[2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]", 799.5)), HasSubstr("no rotation"));
  EXPECT_THAT(refusal(R"({"class_name": "ViewTrajectory", "trajectory": [{}, {}]})"), HasSubstr("2 views"));
  EXPECT_THAT(refusal(R"({"class_name": "ViewTrajectory", "trajectory": [{}]})"),
              HasSubstr("field_of_view is missing"));
}

TEST(ReadCamera, RefusesByFileAndKey) {
  const auto refusal = [](const std::string& json) { return test::refusal_of<UsageError>([&] { camera_in(json); }); };
  EXPECT_THAT(refusal("{"), HasSubstr("camera.json: parse error at line 1"));
  EXPECT_THAT(refusal("[]"), HasSubstr("expected a JSON object"));
  EXPECT_THAT(refusal(R"({"position": [0, 0, 0]})"), HasSubstr("unknown key \"position\""));
  EXPECT_THAT(refusal(R"({"up": [0, 0, 1], "up": [0, 1, 0]})"), HasSubstr("key \"up\" is given twice"));
  EXPECT_THAT(refusal(R"({"position_m": [0, 0]})"), HasSubstr("position_m: expected [x, y, z]"));
  EXPECT_THAT(refusal(R"({"position_m": [0, 0, "a"]})"), HasSubstr("is not a number"));
  EXPECT_THAT(refusal(R"({"position_m": [0, 0, 0]})"), HasSubstr("target_m is missing"));
  EXPECT_THAT(refusal(R"({"position_m": [0, 0, 0], "target_m": [0, 0, 0]})"), HasSubstr("are the same"));
  EXPECT_THAT(refusal(R"({"position_m": [0, 0, 1], "target_m": [0, 0, 0]})"), HasSubstr("up is along the view"));
  EXPECT_THAT(refusal(R"({"position_m": [1, 0, 0], "target_m": [0, 0, 0], "field_of_view_deg": 180})"),
              HasSubstr("field_of_view_deg: 180 must lie between 0 and 180"));
  EXPECT_THAT(test::refusal_of<UsageError>([] { read_camera("/none.json"); }),
              StartsWith("/none.json: cannot be read"));
  EXPECT_THAT(test::refusal_of<UsageError>([] { view_from_name("back"); }), HasSubstr("\"back\" is none of top"));
}

}  // namespace camera_test
}  // namespace cmap
