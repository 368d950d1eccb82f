#include "cmap/sim/camera_view.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/core/execution.hpp"
#include "sim/sim_testing.hpp"

namespace cmap {
namespace camera_view_test {

using testing::aerial;
using ::testing::HasSubstr;
using testing::indoor;
using testing::looking;
using testing::pinhole;
using testing::TempFolder;
using ::testing::ThrowsMessage;
using testing::town;

/// 80 x 80 m at z = 0 of one color (0.5: 127.5 of 255).
Scene gray_plane(const TempFolder& folder) {
  return read_mesh_scene(folder.write("plane.obj",
                                      "v -40 -40 0 .5 .5 .5\nv 40 -40 0 .5 .5 .5\nv 40 40 0 .5 .5 .5\n"
                                      "v -40 40 0 .5 .5 .5\nf 1 2 3 4\n"));
}

CameraModel distorted() {
  CameraModel camera = pinhole(161, 121, 120.0);
  camera.distortion = {-0.25, 0.08, 0.001, -0.0008, 0.01};
  return camera;
}

CameraModel fisheye() {
  CameraModel camera = pinhole(161, 121, 60.0);
  camera.projection = CameraProjection::kFisheye;
  camera.distortion = {-0.02, 0.003, 0.0, 0.0};
  return camera;
}

TEST(RenderView, DepthOfAPlaneIsExact) {
  const TempFolder folder;
  const Scene scene = gray_plane(folder);
  for (const CameraModel& camera : {pinhole(161, 121, 120.0), distorted(), fisheye()}) {
    const Eigen::Isometry3d pose = looking({1.0, 2.0, 3.0}, {0.3, 0.5, -0.8});
    const CameraView view = render_view(scene, camera, pose, {.supersampling = 1});
    int checked = 0;
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3d ray = ray_of(camera, Eigen::Vector2d(x, y)), world = pose.linear() * ray;
        const double distance = -3.0 / world.z();
        const Eigen::Vector3d point = pose.translation() + distance * world;
        if (world.z() > -1e-3 || point.head<2>().cwiseAbs().maxCoeff() > 39.9) continue;
        const float depth = view.depth_m[static_cast<std::size_t>(y * camera.width + x)];
        EXPECT_NEAR(distance * ray.z(), depth, 2e-6 * std::abs(depth) + 1e-7);  // float
        ++checked;
      }
    }
    EXPECT_GT(checked, 10000);
  }
}

TEST(RenderView, GainAndVignettingScaleTheImage) {
  const TempFolder folder;
  const Scene scene = gray_plane(folder);
  const CameraModel camera = pinhole(101, 101, 100.0);
  const Eigen::Isometry3d pose = looking({0, 0, 3}, {1e-6, 0, -1});
  const auto at = [&](const ViewOptions& options, int x, int y) {
    return render_view(scene, camera, pose, options).image.at(x, y)[1];
  };
  EXPECT_EQ(128, at({}, 50, 50));
  EXPECT_EQ(128, at({}, 0, 0));
  EXPECT_EQ(153, at({.exposure_gain = 1.2}, 50, 50));
  EXPECT_EQ(255, at({.exposure_gain = 3.0}, 50, 50));
  EXPECT_EQ(128, at({.vignetting = 0.4}, 50, 50));
  EXPECT_EQ(77, at({.vignetting = 0.4}, 0, 0));    // 127.5 (1 - 0.4) = 76.5
  EXPECT_EQ(102, at({.vignetting = 0.4}, 0, 50));  // half of the squared radius
  EXPECT_THAT([&] { render_view(scene, camera, pose, {.supersampling = 0}); },
              ThrowsMessage<UsageError>(HasSubstr("supersampling is 0")));
  EXPECT_THAT([&] { render_view(scene, camera, pose, {.vignetting = 1.5}); },
              ThrowsMessage<UsageError>(HasSubstr("vignetting is 1.5")));
}

TEST(RenderView, SkyIsInfinitelyFarAndColored) {
  const TempFolder folder;
  const Scene scene = gray_plane(folder);
  const CameraView view = render_view(scene, pinhole(64, 48, 60.0), looking({0, 0, 3}, {1, 0, 0.8}));
  EXPECT_TRUE(std::isinf(view.depth_m.front()));
  EXPECT_GT(view.image.at(0, 0)[2], view.image.at(0, 0)[0]);  // blue
}

TEST(RenderView, IsTheSameForAnyNumberOfThreads) {
  const auto view = [] { return render_view(town(), distorted(), looking({-60, -30, 1.6}, {1, 0.2, 0})); };
  const CameraView many = view();
  const ExecutionScope one({.threads = 1});
  const CameraView single = view();
  EXPECT_TRUE(many.image.pixels == single.image.pixels);
  EXPECT_TRUE(many.depth_m == single.depth_m);
}

/// Where a camera stands in each scene, and where it looks.
struct Place {
  const Scene& scene;
  Eigen::Isometry3d pose;
};
std::vector<Place> places() {
  return {{town(), looking({-60, -30, 1.6}, {1, 0.2, 0})},
          {town(), looking({20, -30, 1.7}, {0.3, 1, 0.1})},
          {indoor(), looking({-10, -6.4, 1.5}, {1, -0.15, -0.1})},
          {aerial(), looking({-50, -20, 14}, {0.2, 0.3, -1})}};
}

TEST(RenderView, DepthLeadsBackToTheScene) {
  for (const Place& place : places()) {
    const CameraModel camera = distorted();
    const CameraView view = render_view(place.scene, camera, place.pose, {.supersampling = 1});
    int finite = 0, met = 0;
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const double depth = view.depth_m[static_cast<std::size_t>(y * camera.width + x)];
        if (!std::isfinite(depth)) continue;
        ++finite;
        const Eigen::Vector3d ray = ray_of(camera, Eigen::Vector2d(x, y));
        const Eigen::Vector3d point = place.pose * Eigen::Vector3d(ray * depth / ray.z()),
                              along = place.pose.linear() * ray;
        // From close by, whatever the camera's own ray was.
        const auto hit = place.scene.probe(point - 0.002 * along, along, 0.004);
        if (!hit) continue;
        const double off = (hit->distance_m - 0.002) * std::abs(hit->normal.cast<double>().dot(along));
        met += std::abs(off) < 1e-4 ? 1 : 0;
      }
    }
    ASSERT_GT(finite, 10000);
    // The others are at edges of leaves and the like, and where rays almost graze the surface.
    EXPECT_GT(met, 0.995 * finite);
  }
}

/// Bilinear, none outside.
std::optional<Eigen::Vector3d> color_at(const RgbImage& image, const Eigen::Vector2d& pixel) {
  const int x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(std::floor(pixel.y()));
  if (x < 0 || y < 0 || x + 1 >= image.width || y + 1 >= image.height) return std::nullopt;
  const double tx = pixel.x() - x, ty = pixel.y() - y;
  Eigen::Vector3d result;
  for (std::size_t c = 0; c < 3; ++c) {
    result[static_cast<int>(c)] = (1 - ty) * ((1 - tx) * image.at(x, y)[c] + tx * image.at(x + 1, y)[c]) +
                                  ty * ((1 - tx) * image.at(x, y + 1)[c] + tx * image.at(x + 1, y + 1)[c]);
  }
  return result;
}

TEST(RenderView, PointsOfTheSceneHaveTheirColorInTheImage) {
  for (const Place& place : places()) {
    CameraModel camera = pinhole(1280, 960, 1000.0);
    camera.distortion = {-0.1, 0.02, 0.001, -0.0008};
    const CameraView view = render_view(place.scene, camera, place.pose, {.supersampling = 2});
    const PointCloud cloud = sample_surface(place.scene, 14.0, 3);
    const Eigen::Isometry3d T_camera_world = place.pose.inverse();
    std::vector<double> errors;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d p = T_camera_world * cloud.world(i);
      const auto pixel = project(camera, p);
      // Textures are finer than the pixels of far surfaces: 2 cm and more are resolved.
      if (!pixel || p.z() > 15.0) continue;
      const auto color = color_at(view.image, *pixel);
      if (!color) continue;
      const auto nearest = static_cast<std::size_t>(std::lround(pixel->y()) * camera.width + std::lround(pixel->x()));
      if (std::abs(static_cast<double>(view.depth_m[nearest]) - p.z()) > 0.002 * p.z()) continue;  // hidden
      const Rgb8& truth = std::get<Array<Rgb8>>(cloud.colors)[i];
      errors.push_back((Eigen::Vector3d(truth[0], truth[1], truth[2]) - *color).cwiseAbs().mean());
    }
    ASSERT_GT(errors.size(), 1000U);
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
    const double median = errors[errors.size() / 2];
    RecordProperty("median_error", std::to_string(median));
    EXPECT_LT(median, 3.0);
  }
}

}  // namespace camera_view_test
}  // namespace cmap
