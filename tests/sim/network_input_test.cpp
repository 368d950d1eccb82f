#include "cmap/sim/network_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "sim/sim_testing.hpp"

namespace cmap {
namespace network_input_test {

using testing::pinhole;

TEST(NetworkCamera, HasTheSizesOfTheRelease) {
  const auto size = [](int w, int h) {
    const CameraModel c = network_camera(pinhole(w, h, 1000.0));
    return std::pair(c.width, c.height);
  };
  EXPECT_EQ(size(2448, 2048), std::pair(518, 434));
  EXPECT_EQ(size(1440, 1080), std::pair(518, 392));
  EXPECT_EQ(size(1280, 1024), std::pair(518, 420));
  EXPECT_EQ(size(1241, 376), std::pair(518, 154));
  EXPECT_EQ(size(1000, 1000), std::pair(518, 518));
  EXPECT_EQ(size(1000, 500), std::pair(518, 252)) << "18.5 patches: half to even";
  EXPECT_THROW(network_camera(pinhole(640, 480, 500), 100), UsageError);
}

TEST(NetworkCamera, ScalesTheAxesApartAndCropsTallImages) {
  CameraModel mars = pinhole(2448, 2048, 1444.43);
  mars.cx = 1178.0;
  mars.distortion = {-0.05, 0.12, 0, 0};
  const CameraModel c = network_camera(mars);
  EXPECT_DOUBLE_EQ(c.fx, 1444.43 * 518 / 2448);
  EXPECT_DOUBLE_EQ(c.fy, 1444.43 * 434 / 2048);
  EXPECT_EQ(c.cx, 259.0);
  EXPECT_EQ(c.cy, 217.0);
  EXPECT_TRUE(c.distortion.empty());
  const CameraModel tall = network_camera(pinhole(1080, 1920, 900.0));
  EXPECT_EQ(tall.height, 518);
  EXPECT_DOUBLE_EQ(tall.fy, 900.0 * 924 / 1920) << "scaled as the 924 rows, of which 518 are left";
  EXPECT_EQ(tall.cy, 259.0);
}

/// Brightness that grows with the pixel: red along u, green along v.
RgbImage ramp(int width, int height) {
  RgbImage image{width, height, {}};
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      image.pixels.push_back({static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(2 * v), 7});
    }
  }
  return image;
}

TEST(NetworkImage, OfACameraLikeItIsThePicture) {
  const CameraModel own = network_camera(pinhole(140, 98, 100.0), 140), network = network_camera(own, 140);
  ASSERT_EQ(network.height, 98);
  const RgbImage picture = ramp(140, 98);
  EXPECT_EQ(network_image(picture, own, network).image.pixels, picture.pixels);
}

TEST(NetworkImage, AveragesThePixelsThatItCovers) {
  const CameraModel own = network_camera(pinhole(84, 84, 50.0), 84), network = network_camera(own, 28);
  RgbImage dots{84, 84, Array<Rgb8>(84 * 84, Rgb8{0, 0, 0})};
  // Pixel (u, v) of the network covers the columns 3u - 1 .. 3u + 1: principal points at w / 2 are at pixel centers.
  dots.pixels[30 * 84 + 30] = {252, 90, 9};
  const RgbImage small = network_image(dots, own, network).image;
  EXPECT_EQ(small.at(10, 10), (Rgb8{28, 10, 1})) << "a ninth of the one pixel in it";
  EXPECT_EQ(small.at(11, 10), (Rgb8{0, 0, 0}));
}

/// Of pixels at the edge, only a part lies on the picture: they are no darker for it.
TEST(NetworkImage, OfOneColorIsOfThatColorToItsEdges) {
  for (const int width : {320, 252, 1036, 126, 84}) {
    const CameraModel own = pinhole(width, 3 * width / 4, 0.7 * width), network = network_camera(own, 126);
    RgbImage gray{own.width, own.height, {}};
    gray.pixels.assign(static_cast<std::size_t>(own.width) * static_cast<std::size_t>(own.height), Rgb8{90, 100, 110});
    const NetworkImage small = network_image(gray, own, network);
    EXPECT_THAT(small.image.pixels, ::testing::Each(Rgb8{90, 100, 110})) << width;
    EXPECT_THAT(small.is_shown, ::testing::Each(1)) << width;
  }
}

TEST(NetworkImage, UndistortsThePicture) {
  CameraModel own = pinhole(120, 90, 80.0);
  own.distortion = {-0.2, 0.05, 0.0, 0.0};
  const CameraModel network = network_camera(own, 112);
  const RgbImage small = network_image(ramp(120, 90), own, network).image;
  for (const auto& [u, v] : {std::pair(56, 42), std::pair(10, 40), std::pair(100, 70)}) {
    const Eigen::Vector3d ray((u - network.cx) / network.fx, (v - network.cy) / network.fy, 1.0);
    const Eigen::Vector2d at = project(own, ray).value();
    EXPECT_NEAR(small.at(u, v)[0], at.x(), 1.0) << "a ramp's mean is its middle, to rounding";
    EXPECT_NEAR(small.at(u, v)[1], 2.0 * at.y(), 1.0);
  }
}

TEST(NetworkImage, IsBlackWhereThePictureEndsAndSaysWhatDoesNotFit) {
  CameraModel own = pinhole(120, 90, 80.0);
  own.cx = 20.0;
  const CameraModel network = network_camera(own, 112);
  const NetworkImage small = network_image(ramp(120, 90), own, network);
  EXPECT_EQ(small.image.at(2, 42), (Rgb8{0, 0, 0})) << "the picture's principal point is far left";
  EXPECT_EQ(small.is_shown[42 * 112 + 2], 0);
  EXPECT_EQ(small.image.at(100, 42)[2], 7);
  EXPECT_EQ(small.is_shown[42 * 112 + 100], 1);
  EXPECT_THROW(network_image(ramp(90, 120), own, network), UsageError);
}

TEST(NetworkImage, IsTheSameForAnyNumberOfThreads) {
  const CameraModel own = pinhole(640, 480, 400.0), network = network_camera(own, 518);
  const RgbImage both = network_image(ramp(640, 480), own, network).image;
  const ExecutionScope one({.threads = 1});
  EXPECT_EQ(network_image(ramp(640, 480), own, network).image.pixels, both.pixels);
}

}  // namespace network_input_test
}  // namespace cmap
