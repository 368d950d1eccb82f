#include "cmap/render/figure.hpp"

#include "cmap/core/execution.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace figure_test {

using ::testing::HasSubstr;

/// Pixels of a red map, however shaded.
std::size_t n_red(const Image& image) {
  return static_cast<std::size_t>(
      std::ranges::count_if(image.pixels, [](const Rgba8& p) { return p[0] > 60 && p[1] == 0 && p[2] == 0; }));
}

Image picture(const IndexedMap& map, const FigureOptions& options = {400, 300, Background::kWhite, 1.0}) {
  const PointBlocks& points = map.index.points;
  const Layer layers[] = {make_layer(map, "map")};
  return draw_figure(layers, camera_for(View::kOblique, points, panel_aspect(1, options), false), options);
}

TEST(DrawFigure, IsTheSameForAnyNumberOfThreads) {
  const IndexedMap map(test::painted_sheet(50'000, 1));
  Array<Rgba8> pixels[2];
  for (int threads : {1, 2}) {
    const ExecutionScope limit({.threads = threads});
    pixels[threads - 1] = picture(map).pixels;
  }
  EXPECT_EQ(pixels[0], pixels[1]);
}

TEST(DrawFigure, OnePointFlatAndFarMapsAreSeen) {
  const auto reds = [&](PointCloud cloud) {
    cloud.colors = Array<Rgb8>(cloud.size(), Rgb8{200, 0, 0});
    return n_red(picture(IndexedMap(cloud)));
  };
  EXPECT_GT(reds(test::small_map({{1, 2, 3}})), 0u);
  PointCloud flat;
  for (int i = 0; i < 10'000; ++i)
    flat.positions.push_back({static_cast<float>(i % 100), static_cast<float>(i / 100), 0});
  const std::size_t here = reds(flat);
  EXPECT_GT(here, 400u * 300u / 10u) << "the plane fills a good part of the picture";
  flat.origin = {1e6, 4e6, 0};
  EXPECT_EQ(reds(flat), here) << "wherever it lies";
}

/// Steps of 2 m, in whose corners the shading of a map's own colors is deep.
PointBlocks stairs() {
  PointCloud cloud;
  for (int i = 0; i < 400 * 400; ++i) {
    const int x = i % 400, y = i / 400;
    cloud.positions.push_back({0.05f * static_cast<float>(x), 0.05f * static_cast<float>(y),
                               2.0f * static_cast<float>((x / 40 + y / 40) % 4)});
  }
  return sort_points(cloud);
}

/// How many of the pixels of the picture's upper right, where no writing is, are the color, and how many are neither it
/// nor the color over the white of its edges.
std::pair<std::size_t, std::size_t> true_and_false_pixels(const Image& image, Rgb8 color) {
  std::size_t n_true = 0, n_false = 0;
  for (int y = 32; y < 160; ++y) {
    for (int x = 200; x < 388; ++x) {
      const Rgba8& p = image.at(x, y);
      const double cover = (255.0 - p[0]) / (255.0 - color[0]);
      bool is_mixed = cover < 1.01;
      for (std::size_t c = 0; c < 3; ++c)
        is_mixed = is_mixed && std::abs(255.0 - cover * (255.0 - color[c]) - p[c]) < 3.0;
      if (p[0] == color[0] && p[1] == color[1] && p[2] == color[2]) {
        ++n_true;
      } else if (!is_mixed) {
        ++n_false;
      }
    }
  }
  return {n_true, n_false};
}

/// A patch of one value has the color that the color bar has there, from wherever it is seen.
TEST(DrawFigure, ColorsWithALegendAreThoseOfTheLegend) {
  const PointBlocks points = stairs();
  const Rgb8 color = color_table(ColorMap::kViridis)[128];
  Layer bar, classes, own;
  bar.scale = ColorScale{};
  classes.classes = {{"all", color}};
  const FigureOptions options{400, 300, Background::kWhite, 1.0};
  for (View view : {View::kTop, View::kOblique, View::kFront, View::kSide, View::kFit}) {
    for (bool orthographic : {false, true}) {
      const Camera camera = camera_for(view, points, panel_aspect(1, options), orthographic);
      const auto pixels = [&](Layer layer) {
        layer.points = &points;
        layer.colors = Array<Rgb8>(points.size, color);
        return true_and_false_pixels(draw_figure({&layer, 1}, camera, options), color);
      };
      for (const Layer* layer : {&bar, &classes}) {
        const auto [n_true, n_false] = pixels(*layer);
        EXPECT_GT(n_true, 500u) << static_cast<int>(view) << orthographic;
        EXPECT_EQ(n_false, 0u) << static_cast<int>(view) << orthographic;
      }
      EXPECT_GT(pixels(own).second, 20u) << "a map's own colors are shaded " << static_cast<int>(view) << orthographic;
    }
  }
}

TEST(DrawFigure, BackgroundsAreWhatTheyAreCalled) {
  const IndexedMap map(test::painted_sheet(1000, 2));
  const auto corner = [&](Background background) { return picture(map, {400, 300, background, 1.0}).at(399, 0); };
  EXPECT_EQ(corner(Background::kWhite), (Rgba8{255, 255, 255, 255}));
  EXPECT_EQ(corner(Background::kBlack), (Rgba8{0, 0, 0, 255}));
  EXPECT_EQ(corner(Background::kTransparent)[3], 0);
}

TEST(DrawFigure, RefusesSizesWithoutRoom) {
  const IndexedMap map(test::painted_sheet(100, 3));
  const auto refusal = [&](int width, int height) {
    return test::refusal_of<UsageError>([&] { picture(map, {width, height, Background::kWhite, 1.0}); });
  };
  EXPECT_THAT(refusal(0, 300), HasSubstr("0 x 300 pixels is no picture"));
  EXPECT_THAT(refusal(100'000, 300), HasSubstr("too large"));
  EXPECT_THAT(refusal(50, 50), HasSubstr("no room"));
}

TEST(Image, BlendsByAlpha) {
  Image image(2, 1, {100, 100, 100, 255});
  blend(image, 0, 0, {200, 0, 100, 51});  // a fifth
  EXPECT_EQ(image.at(0, 0), (Rgba8{120, 80, 100, 255}));
  Image clear(1, 1, {255, 255, 255, 0});
  blend(clear, 0, 0, {10, 20, 30, 128});
  EXPECT_EQ(clear.at(0, 0), (Rgba8{10, 20, 30, 128}));
}

TEST(DrawText, LeavesInkOfItsWidth) {
  Image image(300, 40, {255, 255, 255, 255});
  draw_text(image, 10, 20, "LCR 82.5 %", 18, {0, 0, 0, 255});
  int left = 300, right = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 300; ++x) {
      if (image.at(x, y)[0] > 128) continue;
      left = std::min(left, x);
      right = std::max(right, x);
    }
  }
  EXPECT_NEAR(left, 10, 3);
  EXPECT_NEAR(right - left, text_width("LCR 82.5 %", 18), 4);
}

}  // namespace figure_test
}  // namespace cmap
