#include "cmap/gl/splat_gl.hpp"

#include "cmap/io/point_cloud_file.hpp"
#include "cmap/render/camera.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace splat_gl_test {

/// One device for all tests; skips where there is none.
class SplatGl : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      if (device_ == nullptr) device_ = new GlSplatter;  // never destroyed: drivers clean up in no fixed order at exit
    } catch (const UsageError& error) {
      GTEST_SKIP() << error.what();
    }
  }

  static PixelMap draw(const PointBlocks& points, const Projection& projection, const SplatOptions& options) {
    PixelMap pixels{projection.width_px, projection.height_px, {}};
    pixels.cells.resize(static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height));
    device_->splat(points, projection, options, pixels);
    return pixels;
  }

  static GlSplatter* device_;
};

GlSplatter* SplatGl::device_ = nullptr;

/// Same points, same depths. A GPU may divide and add with other last bits than the CPU: that moves the square of a
/// point that lies within a millionth of a pixel's edge, and swaps points whose depths differ by as little.
void expect_alike(const PixelMap& drawn, const PixelMap& expected) {
  constexpr double kShare = 0.001;
  ASSERT_EQ(drawn.cells.size(), expected.cells.size());
  std::size_t n_other = 0, n_seen = 0;
  for (std::size_t cell = 0; cell < expected.cells.size(); ++cell) {
    n_seen += expected.is_empty(cell) ? 0 : 1;
    if (drawn.is_empty(cell) != expected.is_empty(cell)) {
      ++n_other;
    } else if (!drawn.is_empty(cell)) {
      if (drawn.slot(cell) != expected.slot(cell)) {
        ++n_other;
      } else {
        ASSERT_NEAR(drawn.depth_m(cell), expected.depth_m(cell), 1e-6f * expected.depth_m(cell)) << cell;
      }
    }
  }
  EXPECT_GT(n_seen, 0u);
  EXPECT_LE(static_cast<double>(n_other), kShare * static_cast<double>(n_seen)) << "of " << n_seen;
}

TEST_F(SplatGl, SeesWhatTheSplatterSees) {
  const PointBlocks points = sort_points(test::sheet_cloud(200'000, 4));
  for (const bool orthographic : {false, true}) {
    const Projection projection(camera_for(View::kOblique, points, 1.5, orthographic), 600, 400);
    const double spacing = typical_spacing_m(points);
    for (const SplatOptions& options :
         {SplatOptions{0.0, 1.0, 1.0}, {2.0 * spacing, 2.0, 48.0}, {20.0 * spacing, 1.0, 48.0}}) {
      SCOPED_TRACE(options.point_size_m);
      expect_alike(draw(points, projection, options), splat(points, projection, options));
    }
  }
}

TEST_F(SplatGl, SeesTheTownOfTheSample) {
  const PointBlocks points = sort_points(read_point_cloud(test::source_path("data_samples/town/reference.ply")).cloud);
  const Projection projection(camera_for(View::kOblique, points, 1.6, false), 800, 500);
  expect_alike(draw(points, projection, {0.1, 2.0, 48.0}), splat(points, projection, {0.1, 2.0, 48.0}));
}

TEST_F(SplatGl, ACloseCameraSeesSquaresThatBeginOutsideOfThePicture) {
  const PointBlocks points = sort_points(test::uniform_cloud(3000, 5, 8.0f));
  Camera camera;
  camera.position = {4, 4, 4};
  camera.target = {4, 8, 4};
  camera.field_of_view_deg = 70.0;
  const Projection projection(camera, 97, 61);  // points behind it, too
  expect_alike(draw(points, projection, {0.5, 1.0, 48.0}), splat(points, projection, {0.5, 1.0, 48.0}));
}

TEST_F(SplatGl, OnePointAndAFlatMap) {
  const PointBlocks one = sort_points(test::small_map({{1, 2, 3}}));
  const Projection on_one(camera_for(View::kOblique, one, 1.0, false), 50, 50);
  expect_alike(draw(one, on_one, {0.0, 14.0, 48.0}), splat(one, on_one, {0.0, 14.0, 48.0}));
  PointCloud flat;
  for (int i = 0; i < 10'000; ++i)
    flat.positions.push_back({static_cast<float>(i % 100), static_cast<float>(i / 100), 0});
  const PointBlocks plane = sort_points(flat);
  const Projection on_plane(camera_for(View::kTop, plane, 1.0, true), 300, 300);
  expect_alike(draw(plane, on_plane, {1.0, 1.0, 48.0}), splat(plane, on_plane, {1.0, 1.0, 48.0}));
}

TEST_F(SplatGl, FarFromTheOriginNothingChanges) {
  PointCloud cloud = test::sheet_cloud(20'000, 6);
  const PointBlocks here = sort_points(cloud);
  const Camera camera = camera_for(View::kOblique, here, 1.0, false);
  const PixelMap near_origin = draw(here, Projection(camera, 300, 300), {0.05, 1.0, 48.0});
  const Eigen::Vector3d far(1e6, 4e6, 0);
  cloud.origin += far;
  Camera moved = camera;
  moved.position += far;
  moved.target += far;
  const PointBlocks there = sort_points(cloud);
  const PixelMap far_away = draw(there, Projection(moved, 300, 300), {0.05, 1.0, 48.0});
  expect_alike(far_away, splat(there, Projection(moved, 300, 300), {0.05, 1.0, 48.0}));
  // The camera's place is rounded to 1e-9 m, which moves few squares.
  expect_alike(far_away, near_origin);
}

TEST_F(SplatGl, EquallyNearPointsGoToTheLowerSlot) {
  const PointBlocks points = sort_points(test::small_map({{4, 4, 1}, {4, 4, 1}, {4, 4, 1}}));
  const Projection projection(camera_for(View::kTop, points, 1.0, true), 21, 21);
  const PixelMap pixels = draw(points, projection, {0.0, 5.0, 5.0});
  EXPECT_EQ(std::ranges::count_if(pixels.cells, [](std::uint64_t cell) { return cell != PixelMap::kEmpty; }), 25);
  EXPECT_EQ(pixels.slot(10 * 21 + 10), 0u);
}

/// Depths apart by the last bit of a float, whichever of two points is drawn first.
TEST_F(SplatGl, DepthsKeepAllBitsOfTheirFloats) {
  const PointBlocks points = sort_points(test::small_map({{0, 0, 0}, {0, 0, 0.0625f}}));
  for (const double side : {-1.0, 1.0}) {
    Camera camera;
    camera.position = {0, 0, side * 1'000'000};
    camera.target = {0, 0, 0};
    camera.up = Eigen::Vector3d::UnitY();
    camera.orthographic = true;
    const PixelMap drawn = draw(points, Projection(camera, 3, 3), {0.0, 1.0, 1.0});
    EXPECT_EQ(drawn.cells, splat(points, Projection(camera, 3, 3), {0.0, 1.0, 1.0}).cells);
    EXPECT_EQ(drawn.depth_m(4), side < 0.0 ? 1'000'000.0f : 999'999.9375f);
  }
}

TEST_F(SplatGl, LargePicturesAreDrawnInTiles) {
  const PointBlocks points = sort_points(test::sheet_cloud(30'000, 7));
  const Projection projection(camera_for(View::kTop, points, 1.0, false), 20'000, 40);
  expect_alike(draw(points, projection, {0.05, 3.0, 48.0}), splat(points, projection, {0.05, 3.0, 48.0}));
}

TEST_F(SplatGl, MoreThanOneBatchOfPoints) {
  const PointBlocks points = sort_points(test::sheet_cloud(2'200'000, 8));
  const Projection projection(camera_for(View::kFit, points, 1.0, false), 300, 300);
  expect_alike(draw(points, projection, {0.0, 1.0, 2.0}), splat(points, projection, {0.0, 1.0, 2.0}));
}

}  // namespace splat_gl_test
}  // namespace cmap
