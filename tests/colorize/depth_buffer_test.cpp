#include "cmap/colorize/depth_buffer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cmap/core/execution.hpp"
#include "colorize/colorize_testing.hpp"

namespace cmap {
namespace depth_buffer_test {

using test::small_fisheye;
using test::small_pinhole;

/// A wall across the camera's view, in its frame, with points every 5 cm.
void add_wall(PointCloud& cloud, double z, double half_width, double half_height) {
  for (double x = -half_width; x < half_width; x += 0.05) {
    for (double y = -half_height; y < half_height; y += 0.05) {
      cloud.positions.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    }
  }
}

/// Seen and inside, by place in the cloud.
std::vector<bool> seen_by(const PointCloud& cloud, const CameraModel& camera, const OcclusionOptions& options) {
  const Surfels surfels = surfels_of(cloud, {12, 0.05, 0.25});
  const Array<ViewPoint> points = points_in_view(surfels, camera, Eigen::Isometry3d::Identity(), options);
  DepthBuffer buffer(camera, options);
  buffer.fill(points);
  std::vector<bool> seen(cloud.size(), false);
  for (const ViewPoint& point : points) {
    if (point.is_inside && !buffer.hides(point)) seen[surfels.original_index[point.slot]] = true;
  }
  return seen;
}

bool is_on_image(const CameraModel& camera, const Eigen::Vector3d& p) {
  const auto pixel = project(camera, p);
  return pixel && is_inside(camera, *pixel);
}

/// A wall of 1 m at 2 m hides what lies in its shadow on one at 6 m, and nothing else.
void check_walls(const CameraModel& camera) {
  PointCloud cloud;
  add_wall(cloud, 2.0, 0.5, 0.5);
  const std::size_t n_near = cloud.size();
  add_wall(cloud, 6.0, 3.0, 2.0);
  const std::vector<bool> seen = seen_by(cloud, camera, {});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f p = cloud.positions[i];
    if (!is_on_image(camera, p.cast<double>())) continue;
    const float across = std::max(std::abs(p.x()), std::abs(p.y())) * (2.0f / p.z());  // at the near wall
    // Its edge lies at 0.5, half a disc farther on average, and the edge's own margin is at most 4 cm there.
    const bool is_free = i < n_near || across > 0.62f, is_behind = !is_free && across < 0.45f;
    if (is_free || is_behind) {
      EXPECT_EQ(seen[i], is_free) << p.transpose();
    }
  }
}

TEST(DepthBuffer, AWallHidesTheOneBehindIt) { check_walls(small_pinhole()); }
TEST(DepthBuffer, ForAFisheyeToo) { check_walls(small_fisheye()); }

TEST(DepthBuffer, OfALargeImageHasFewerPixels) {
  const CameraModel large{CameraProjection::kPinhole, 960, 720, 600, 600, 479.5, 359.5, {}};
  PointCloud cloud;
  add_wall(cloud, 2.0, 0.5, 0.5);
  add_wall(cloud, 6.0, 1.0, 1.0);
  OcclusionOptions options;
  options.most_pixels = 100'000;
  EXPECT_EQ(DepthBuffer(large, options).width(), 320);
  const std::vector<bool> seen = seen_by(cloud, large, options);
  for (std::size_t i = 0; i < cloud.size(); ++i) EXPECT_EQ(seen[i], cloud.positions[i].z() < 3.0f);
}

/// Ground from 1.5 m above it, out to where it is seen at 3 degrees: squares of one depth would hide most of it.
/// Noise of a centimeter hides a tenth, where a ray runs 20 cm between them.
TEST(DepthBuffer, FlatGroundDoesNotHideItself) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.01);
  PointCloud ground;
  for (double z = 3.0; z < 28.0; z += 0.1) {
    for (double x = -2.0; x < 2.0; x += 0.1) {
      ground.positions.push_back(Eigen::Vector3d(x, 1.5 + noise(random), z).cast<float>());
    }
  }
  const std::vector<bool> seen = seen_by(ground, small_pinhole(), {});
  double n_seen = 0, n_inside = 0;
  for (std::size_t i = 0; i < ground.size(); ++i) {
    if (!is_on_image(small_pinhole(), ground.world(i))) continue;
    n_inside += 1.0;
    n_seen += seen[i] ? 1.0 : 0.0;
  }
  EXPECT_GT(n_seen / n_inside, 0.85);
}

/// Boards here and there, facing anywhere.
PointCloud boards() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1, 1);
  PointCloud cloud;
  for (int board = 0; board < 12; ++board) {
    const Eigen::Vector3d center(2.5 * place(random), 1.5 * place(random), 7.0 + 5.0 * place(random));
    const Eigen::Matrix3d turn = rotation_from({place(random), place(random), place(random)});
    for (double u = -0.7; u < 0.7; u += 0.06) {
      for (double v = -0.7; v < 0.7; v += 0.06) {
        cloud.positions.push_back((center + turn * Eigen::Vector3d(u, v, 0)).cast<float>());
      }
    }
  }
  return cloud;
}

/// Range of the nearest disc on the ray to a point, by asking all of them; those that are nearly edge-on do not count.
double nearest_on_ray(const ViewPoint& point, const Array<ViewPoint>& all) {
  const Eigen::Vector3d ray = point.position.cast<double>().normalized();
  double nearest = INFINITY;
  for (const ViewPoint& other : all) {
    const Eigen::Vector3d n = other.normal.cast<double>(), q = other.position.cast<double>();
    const double cosine = n.dot(ray), range = n.dot(q) / cosine;
    if (std::abs(cosine) < 0.1 || range <= 0 || (range * ray - q).norm() > other.radius_m) continue;
    nearest = std::min(nearest, range);
  }
  return nearest;
}

TEST(DepthBuffer, AgreesWithAskingEveryDisc) {
  OcclusionOptions options;
  options.edge_px = 0.0;
  const Surfels surfels = surfels_of(boards(), {12, 0.06, 0.25});
  for (const CameraModel& camera : {small_pinhole(), small_fisheye()}) {
    const Array<ViewPoint> points = points_in_view(surfels, camera, Eigen::Isometry3d::Identity(), options);
    DepthBuffer buffer(camera, options);
    buffer.fill(points);
    double n_hidden = 0, n_free = 0, n_missed = 0, n_false = 0;
    for (const ViewPoint& point : points) {
      if (!point.is_inside) continue;
      const double before = point.range_m - nearest_on_ray(point, points);
      if (before > 1.2) {  // beyond any tolerance
        n_hidden += 1.0;
        n_missed += buffer.hides(point) ? 0.0 : 1.0;
      } else if (before < 0.1) {
        n_free += 1.0;
        n_false += buffer.hides(point) ? 1.0 : 0.0;
      }
    }
    EXPECT_GT(n_hidden, 200);
    EXPECT_GT(n_free, 1000);
    // A pixel is a ray; at edges it may be another board's.
    EXPECT_LT(n_missed, 0.02 * n_hidden);
    EXPECT_LT(n_false, 0.02 * n_free);
  }
}

TEST(DepthBuffer, IsTheSameForAnyNumberOfThreads) {
  const Surfels surfels = surfels_of(test::PaintedRoom().map(0.1), {12, 0.1, 0.5});
  const Array<ViewPoint> points = points_in_view(surfels, small_pinhole(), test::forward_camera().inverse(), {});
  const auto ranges = [&](int threads) {
    const ExecutionScope scope({.threads = threads});
    DepthBuffer buffer(small_pinhole(), {});
    buffer.fill(points);
    std::vector<float> all;
    for (int y = 0; y < buffer.height(); ++y) {
      for (int x = 0; x < buffer.width(); ++x) all.push_back(buffer.range_m(x, y));
    }
    return all;
  };
  EXPECT_EQ(ranges(1), ranges(4));
}

}  // namespace depth_buffer_test
}  // namespace cmap
