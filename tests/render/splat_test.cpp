#include "cmap/render/splat.hpp"

#include "cmap/core/execution.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace splat_test {

/// Looks down at 8 x 8 m with one pixel for each 0.125 m: pixels of points on that grid are exact.
Projection from_above(int side_px = 64) {
  Camera camera;
  camera.position = {4, 4, 100};
  camera.target = {4, 4, 0};
  camera.up = Eigen::Vector3d::UnitY();
  camera.orthographic = true;
  camera.view_height_m = 8.0;
  return {camera, side_px, side_px};
}

std::size_t cell_at(const PixelMap& pixels, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels.width) + static_cast<std::size_t>(x);
}

TEST(Splat, APointIsWhereItBelongs) {
  const PixelMap pixels = splat(sort_points(test::small_map({{1.0625f, 7.0625f, 2}})), from_above(), {0.0, 1.0, 1.0});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      EXPECT_EQ(pixels.is_empty(cell_at(pixels, x, y)), !(x == 8 && y == 7)) << x << " " << y;
    }
  }
  EXPECT_EQ(pixels.slot(cell_at(pixels, 8, 7)), 0u);
  EXPECT_EQ(pixels.depth_m(cell_at(pixels, 8, 7)), 98.0f);
}

TEST(Splat, SizesAreInMeters) {
  const PixelMap pixels = splat(sort_points(test::small_map({{4, 4, 0}})), from_above(), {0.5, 1.0, 48.0});
  std::size_t covered = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool inside = x >= 30 && x < 34 && y >= 30 && y < 34;
      EXPECT_EQ(pixels.is_empty(cell_at(pixels, x, y)), !inside);
      covered += inside ? 1 : 0;
    }
  }
  EXPECT_EQ(covered, 16u);
}

/// The nearest point of every pixel by a plain loop in double.
TEST(Splat, EqualsBruteForce) {
  PointCloud cloud;
  for (const Eigen::Vector3f& p : test::uniform_cloud(20'000, 3, 8.0f).positions) {
    // Away from the pixels' edges, where float and double may differ.
    const auto inside = [](float v) { return (std::floor(v * 8.0f) + 0.5f) / 8.0f; };
    cloud.positions.push_back({inside(p.x()), inside(p.y()), p.z()});
  }
  const PointBlocks points = sort_points(cloud);
  const PixelMap pixels = splat(points, from_above(), {0.0, 1.0, 1.0});
  std::vector<std::uint32_t> expected(64 * 64, ~0u);
  for (std::uint32_t slot = 0; slot < points.size; ++slot) {
    const Eigen::Vector3d p = points.world(slot);
    const int x = static_cast<int>(std::floor(p.x() * 8.0)), y = 63 - static_cast<int>(std::floor(p.y() * 8.0));
    if (x < 0 || y < 0 || x > 63 || y > 63) continue;
    std::uint32_t& nearest = expected[cell_at(pixels, x, y)];
    // In float, as depths are compared.
    const auto depth = [&](std::uint32_t s) { return 100.0f - points.offset(s).z(); };
    if (nearest == ~0u || depth(slot) < depth(nearest)) nearest = slot;
  }
  for (std::size_t cell = 0; cell < expected.size(); ++cell) {
    ASSERT_EQ(pixels.is_empty(cell), expected[cell] == ~0u) << cell;
    if (!pixels.is_empty(cell)) {
      ASSERT_EQ(pixels.slot(cell), expected[cell]) << cell;
    }
  }
}

TEST(Splat, EquallyNearPointsGoToTheLowerSlot) {
  const PixelMap pixels = splat(sort_points(test::small_map({{4.0625f, 4.0625f, 1}, {4.0625f, 4.0625f, 1}})),
                                from_above(), {0.0, 1.0, 1.0});
  EXPECT_EQ(pixels.slot(cell_at(pixels, 32, 31)), 0u);
}

TEST(Splat, PointsBehindTheCameraAreNotSeen) {
  const PixelMap pixels = splat(sort_points(test::small_map({{4, 4, 200}})), from_above(), {1.0, 1.0, 8.0});
  for (std::size_t cell = 0; cell < pixels.cells.size(); ++cell) EXPECT_TRUE(pixels.is_empty(cell));
}

TEST(Splat, IsTheSameForAnyNumberOfThreads) {
  const PointBlocks points = sort_points(test::sheet_cloud(200'000, 4));
  const Projection projection(camera_for(View::kOblique, points, 1.0, false), 300, 300);
  Array<std::uint64_t> cells[2];
  for (int threads : {1, 2}) {
    const ExecutionScope limit({.threads = threads});
    cells[threads - 1] = splat(points, projection, {0.05, 1.0, 8.0}).cells;
  }
  EXPECT_EQ(cells[0], cells[1]);
}

TEST(TypicalSpacing, IsThatOfASurface) {
  PointCloud grid;
  for (int x = 0; x < 200; ++x) {
    for (int y = 0; y < 200; ++y)
      grid.positions.push_back({0.1f * static_cast<float>(x), 0.1f * static_cast<float>(y), 0});
  }
  // Sixteen points of a grid span 3 to 7 spacings: a rough measure is all that is needed.
  EXPECT_NEAR(typical_spacing_m(sort_points(grid)), 0.1, 0.04);
  EXPECT_EQ(typical_spacing_m(sort_points(test::small_map({{1, 2, 3}}))), 0.0);
}

TEST(EyeDomeShading, DarkensBehindAnEdgeOnly) {
  PointCloud step;  // the right half is 2 m higher
  for (int x = 0; x < 64; ++x) {
    for (int y = 0; y < 64; ++y) {
      step.positions.push_back(
          {(static_cast<float>(x) + 0.5f) / 8.0f, (static_cast<float>(y) + 0.5f) / 8.0f, x < 32 ? 0.0f : 2.0f});
    }
  }
  const PixelMap pixels = splat(sort_points(step), from_above(), {0.0, 1.0, 1.0});
  const Array<float> shading = eye_dome_shading(pixels, from_above(), 1.0);
  for (int x = 0; x < 64; ++x) {
    const float factor = shading[cell_at(pixels, x, 30)];
    if (x == 30 || x == 31) {
      EXPECT_LT(factor, 0.5f) << x;
    } else {
      EXPECT_EQ(factor, 1.0f) << x;
    }
  }
  for (float factor : eye_dome_shading(pixels, from_above(), 0.0)) EXPECT_EQ(factor, 1.0f);
}

}  // namespace splat_test
}  // namespace cmap
