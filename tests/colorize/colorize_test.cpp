#include "cmap/colorize/colorize.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "colorize/colorize_testing.hpp"

namespace cmap {
namespace colorize_test {

using test::mean_color_error;
using test::painted_images;
using test::small_fisheye;
using test::small_pinhole;

const PointCloud& room() {
  static const PointCloud map = test::PaintedRoom().map(0.1);
  return map;
}

TEST(Colorize, ARoomGetsItsColors) {
  for (const CameraModel& camera : {small_pinhole(), small_fisheye()}) {
    const Colorization result = colorize(room(), painted_images(camera, 24));
    EXPECT_GT(static_cast<double>(result.n_seen), 0.7 * static_cast<double>(room().size()));
    EXPECT_LT(mean_color_error(result.cloud), 0.012);
    EXPECT_LT(result.inconsistency, 0.02);
    EXPECT_NEAR(result.surfel_m, 0.1, 1e-5);
    EXPECT_EQ(result.images.size(), 24u);
    for (std::size_t i = 0; i < room().size(); ++i) {
      EXPECT_EQ(std::isnan(std::get<Array<RgbF>>(result.cloud.colors)[i][0]), result.views[i] == 0);
    }
  }
}

TEST(Colorize, ExposuresAreTakenOff) {
  std::vector<double> gains;
  for (int i = 0; i < 25; ++i) gains.push_back(std::exp(0.3 * std::sin(2.0 * i)));
  const PosedImages images = painted_images(small_pinhole(), 25, gains);
  std::vector<double> sorted = gains;
  std::ranges::sort(sorted);
  const Colorization result = colorize(room(), images);
  // A gain of less than 1 / 1.15 loses nothing at white; the others do, by up to a few levels of a few points.
  EXPECT_LT(mean_color_error(result.cloud, sorted[12]), 0.025);
  ColorizeOptions off;
  off.exposure.model = ExposureModel::kNone;
  const Colorization without = colorize(room(), images, off);
  EXPECT_GT(mean_color_error(without.cloud, sorted[12]), 0.05);
  EXPECT_LT(result.inconsistency, 0.5 * without.inconsistency);
}

/// A box in the room's middle: what is behind it keeps its own color.
TEST(Colorize, WhatStandsBetweenIsNotPaintedOnTheWall) {
  PointCloud wall;
  for (double y = -1.5; y < 1.5; y += 0.05) {
    for (double z = -1.5; z < 1.5; z += 0.05) wall.positions.push_back(Eigen::Vector3d(6, y, z).cast<float>());
  }
  const std::size_t n_wall = wall.size();
  for (double y = -0.4; y < 0.4; y += 0.05) {
    for (double z = -0.4; z < 0.4; z += 0.05) wall.positions.push_back(Eigen::Vector3d(3, y, z).cast<float>());
  }
  PosedImages images;
  images.camera = small_pinhole();
  images.T_lidar_camera.linear() = test::forward_camera().linear();
  for (std::size_t i = 0; i < 5; ++i) {
    PosedImage image;
    image.index = i;
    image.T_world_lidar.translation() << 0, 0.5 * (static_cast<double>(i) - 2.0), 0;
    images.list.push_back(image);
  }
  constexpr Rgb8 kRed{200, 20, 20}, kBlue{20, 20, 200};
  images.read = [&](std::size_t place) {
    RgbImage image{320, 240, Array<Rgb8>(320 * 240)};
    const Eigen::Isometry3d T = images.T_world_camera(place);
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        const Eigen::Vector3d ray = T.linear() * ray_of(images.camera, {x, y});
        const Eigen::Vector3d at_box = T.translation() + ray * ((3.0 - T.translation().x()) / ray.x());
        image.at(x, y) = std::max(std::abs(at_box.y()), std::abs(at_box.z())) < 0.4 ? kRed : kBlue;
      }
    }
    return image;
  };
  const Colorization result = colorize(wall, images);
  const auto& colors = std::get<Array<RgbF>>(result.cloud.colors);
  std::size_t n_unseen = 0;
  for (std::size_t i = 0; i < wall.size(); ++i) {
    n_unseen += result.views[i] == 0 ? 1 : 0;
    if (result.views[i] == 0) continue;
    const bool on_the_rim = i >= n_wall && wall.positions[i].tail<2>().cwiseAbs().maxCoeff() > 0.35f;
    if (on_the_rim) continue;
    EXPECT_EQ(colors[i][0] > colors[i][2], i >= n_wall) << wall.positions[i].transpose();
  }
  EXPECT_LT(n_unseen, wall.size() / 20) << "from the sides the cameras see nearly all of the wall";
}

TEST(Colorize, IsTheSameForAnyNumberOfThreads) {
  const PosedImages images = painted_images(small_pinhole(), 10);
  const auto with_threads = [&](int threads) {
    const ExecutionScope scope({.threads = threads});
    return colorize(room(), images);
  };
  const Colorization one = with_threads(1), four = with_threads(4);
  const auto& a = std::get<Array<RgbF>>(one.cloud.colors);
  const auto& b = std::get<Array<RgbF>>(four.cloud.colors);
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(RgbF)), 0);
  EXPECT_EQ(one.inconsistency, four.inconsistency);
  EXPECT_EQ(one.views, four.views);
}

/// However many views there are, few are kept; the best ones give about the same.
TEST(Colorize, AFewViewsOfAPointAreEnough) {
  ColorizeOptions options;
  options.most_views = 3;
  const Colorization result = colorize(room(), painted_images(small_fisheye(), 24), options);
  EXPECT_LT(mean_color_error(result.cloud), 0.012);
  EXPECT_GT(*std::ranges::max_element(result.views), 10u) << "all of them are counted";
}

TEST(Colorize, AWrongCalibrationShowsInTheInconsistency) {
  PosedImages images = painted_images(small_pinhole(), 24);
  const double right = colorize(room(), images).inconsistency;
  images.T_lidar_camera.linear() = images.T_lidar_camera.linear() * rotation_from({0, 0.02, 0});
  EXPECT_GT(colorize(room(), images).inconsistency, 1.5 * right);
}

TEST(Colorize, ViewsCountByAngleRangeAndBorder) {
  const CameraModel camera = small_pinhole();
  ViewPoint head_on;
  head_on.position = {0, 0, 4};
  head_on.normal = {0, 0, 1};
  head_on.range_m = 4;
  head_on.pixel = {159.5f, 119.5f};
  // cos 1, 1 / (1 + (4 / 2)^2), far from the border.
  EXPECT_NEAR(view_weight(head_on, camera, {}), 0.2, 1e-6);
  ViewPoint other = head_on;
  other.normal = Eigen::Vector3f(0, std::sqrt(0.75f), 0.5f);
  EXPECT_NEAR(view_weight(other, camera, {}), 0.1, 1e-6);
  other = head_on;
  other.pixel = {-0.5f, 100.0f};
  EXPECT_NEAR(view_weight(other, camera, {}), 0.02, 1e-6);
  other.pixel = {11.5f, 100.0f};  // half of the tenth of 240 that the ramp takes
  EXPECT_NEAR(view_weight(other, camera, {}), 0.2 * 0.55, 1e-6);
}

TEST(Colorize, ColorsBetweenPixelsAreInterpolated) {
  RgbImage image{2, 2, {{0, 0, 0}, {100, 0, 0}, {0, 100, 0}, {100, 100, 200}}};
  EXPECT_EQ(color_at(image, {0.5f, 0.5f}), (Rgb8{50, 50, 50}));
  EXPECT_EQ(color_at(image, {0.25f, 0.0f}), (Rgb8{25, 0, 0}));
  EXPECT_EQ(color_at(image, {1.4f, -0.4f}), (Rgb8{100, 0, 0})) << "beyond the last center: its pixel";
}

TEST(Colorize, SaysWhatIsWrong) {
  PosedImages images = painted_images(small_pinhole(), 2);
  ColorizeOptions wrong;
  wrong.most_views = 0;
  EXPECT_THROW(colorize(room(), images, wrong), UsageError);
  PointCloud far;
  far.positions = {{900, 0, 0}, {901, 0, 0}, {900, 1, 0}};
  EXPECT_THROW(colorize(far, images), InputError);
  images.read = [](std::size_t) -> RgbImage { throw InputError("no such picture"); };
  EXPECT_THROW(colorize(room(), images), InputError);
}

}  // namespace colorize_test
}  // namespace cmap
