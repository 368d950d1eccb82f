#include "viewer_model.hpp"

#include "cmap/render/panels.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace viewer_model_test {

using Answer = ViewerModel::Answer;

/// A plane of 10 x 10 m seen from above, red and blue layers of it, and a green one of another map.
struct Planes {
  Planes() {
    for (int i = 0; i < 10'000; ++i) {
      cloud.positions.push_back({0.1f * static_cast<float>(i % 100), 0.1f * static_cast<float>(i / 100), 0});
    }
    points = sort_points(cloud);
    other = sort_points(cloud);
    for (const auto& [map, color] :
         {std::pair{&points, Rgb8{200, 0, 0}}, {&points, {0, 0, 200}}, {&other, {0, 200, 0}}}) {
      Layer layer;
      layer.points = map;
      layer.title = std::to_string(layers.size());
      layer.colors = Array<Rgb8>(map->size, color);
      layers.push_back(layer);
    }
    scene.title = "planes";
    scene.layers = layers;
    scene.options.width_px = 500;
    scene.options.height_px = 400;
    scene.camera = camera_for(View::kTop, points, panel_aspect(1, scene.options), true);
    scene.describe_point = [this](const PointBlocks& map, std::size_t slot) {
      described = {&map, slot};
      return std::vector<std::string>{"values"};
    };
  }

  PointCloud cloud;
  PointBlocks points, other;
  std::vector<Layer> layers;
  ViewerScene scene;
  std::pair<const PointBlocks*, std::size_t> described{nullptr, 0};
};

/// Where the pictures's middle is, in the window.
Eigen::Vector2i middle(const Planes& planes) {
  const Rect place = panel_place(0, 1, planes.scene.options);
  return {place.x + place.width / 2, place.y + place.height / 2};
}

Rgba8 middle_color(const Planes& planes, const Image& image) {
  const Eigen::Vector2i at = middle(planes);
  return image.at(at.x(), at.y());
}

TEST(ViewerModel, KeysSwitchLayers) {
  const Planes planes;
  ViewerModel model(planes.scene);
  const auto color_after = [&](std::string_view key) {
    EXPECT_EQ(model.press(key), Answer::kRedraw);
    return middle_color(planes, model.draw(false));
  };
  EXPECT_EQ(middle_color(planes, model.draw(false)), (Rgba8{200, 0, 0, 255}));
  EXPECT_EQ(color_after("2"), (Rgba8{0, 0, 200, 255}));
  EXPECT_EQ(model.title(), "planes - 1");
  EXPECT_EQ(color_after("Right"), (Rgba8{0, 200, 0, 255}));
  EXPECT_EQ(color_after("Right"), (Rgba8{200, 0, 0, 255}));
  EXPECT_EQ(color_after("Left"), (Rgba8{0, 200, 0, 255}));
  EXPECT_EQ(model.press("4"), Answer::kNothing);
  EXPECT_EQ(model.press("F1"), Answer::kNothing);
  EXPECT_EQ(model.press("s"), Answer::kSave);
  EXPECT_EQ(model.press("q"), Answer::kQuit);
  EXPECT_EQ(model.press("Escape"), Answer::kQuit);
}

TEST(ViewerModel, PicksWhatIsUnderThePixel) {
  const Planes planes;
  ViewerModel model(planes.scene);
  const Eigen::Vector2i at = middle(planes);
  EXPECT_EQ(model.pick(at.x() + 50, at.y() - 30), std::vector<std::string>{"values"});
  ASSERT_EQ(planes.described.first, &planes.points);
  const Projection projection(planes.scene.camera, panel_place(0, 1, planes.scene.options).width,
                              panel_place(0, 1, planes.scene.options).height);
  const Eigen::Vector3d expected = planes.scene.camera.target + Eigen::Vector3d(50, 30, 0) / projection.focal_px;
  const Eigen::Vector3d found = planes.points.world(planes.described.second);
  EXPECT_LT((found - expected).head<2>().norm(), 0.2) << "within its square of two spacings";
  EXPECT_TRUE(model.pick(0, 0).empty());
  EXPECT_TRUE(model.pick(-5, 4000).empty());
}

/// Something of another color than the map's about the picture's middle.
bool has_ring(const Planes& planes, ViewerModel& model) {
  const Image image = model.draw(false);
  const Eigen::Vector2i at = middle(planes);
  for (int x = at.x() - 15; x <= at.x() + 15; ++x) {
    if (image.at(x, at.y()) != image.at(at.x(), at.y() + 30)) return true;
  }
  return false;
}

TEST(ViewerModel, ValuesAreOfTheMapThatIsShown) {
  const Planes planes;
  ViewerModel model(planes.scene);
  EXPECT_FALSE(has_ring(planes, model));
  model.pick(middle(planes).x(), middle(planes).y());
  EXPECT_TRUE(has_ring(planes, model));
  model.press("2");
  EXPECT_TRUE(has_ring(planes, model)) << "the same map";
  model.press("3");
  EXPECT_FALSE(has_ring(planes, model)) << "another map";
}

TEST(ViewerModel, HelpComesAndGoes) {
  const Planes planes;
  ViewerModel model(planes.scene);
  const Array<Rgba8> before = model.draw(false).pixels;
  model.press("h");
  EXPECT_NE(model.draw(false).pixels, before);
  model.press("h");
  EXPECT_EQ(model.draw(false).pixels, before);
}

TEST(ViewerModel, MovesAndComesBack) {
  const Planes planes;
  ViewerModel model(planes.scene);
  const Array<Rgba8> before = model.draw_plain().pixels;
  const std::vector<std::function<void()>> moves{[&] { model.drag(ViewerModel::Drag::kTurn, 30, -200); },
                                                 [&] { model.drag(ViewerModel::Drag::kPan, 30, 20); },
                                                 [&] { model.drag(ViewerModel::Drag::kZoom, 0, 20); },
                                                 [&] { model.zoom(0.5); },
                                                 [&] { model.press("plus"); },
                                                 [&] { model.press("minus"); },
                                                 [&] {
                                                   const Eigen::Vector2i at = middle(planes);
                                                   model.pick(at.x() + 50, at.y());
                                                   model.press("f");
                                                 }};
  for (std::size_t i = 0; i < moves.size(); ++i) {
    moves[i]();
    EXPECT_NE(model.draw_plain().pixels, before) << i;
    model.press("r");
    EXPECT_EQ(model.draw_plain().pixels, before) << i;
  }
}

TEST(ViewerModel, PicturesHaveTheWindowsSize) {
  const Planes planes;
  ViewerModel model(planes.scene);
  model.resize(700, 300);
  const Image image = model.draw(true);
  EXPECT_EQ(image.width, 700);
  EXPECT_EQ(image.height, 300);
  model.resize(1, 1);
  EXPECT_GT(model.draw(true).width, 1) << "cut off by the window";
}

TEST(CoarsePoints, AreInSlotsOfTheWholeMap) {
  const PointBlocks points = sort_points(test::sheet_cloud(50'000, 1));
  const Projection projection(camera_for(View::kTop, points, 1.0, true), 100, 100);
  const SplatOptions options{0.0, 1.0, 1.0};
  const PixelMap coarse = CoarsePoints(points, 7'000).splat(splat, projection, options);
  std::size_t n_seen = 0;
  for (std::size_t cell = 0; cell < coarse.cells.size(); ++cell) {
    if (coarse.is_empty(cell)) continue;
    ++n_seen;
    const std::uint32_t slot = coarse.slot(cell);
    ASSERT_LT(slot, points.size);
    ASSERT_EQ(slot % 8, 0u) << "50,000 / 7,000, rounded up";
    const Eigen::Vector3d d = projection.axes * (points.world(slot) - projection.position);
    ASSERT_NEAR(50.0 + projection.focal_px * d.x(), static_cast<double>(cell % 100) + 0.5, 0.51);
    ASSERT_NEAR(50.0 + projection.focal_px * d.y(), static_cast<double>(cell / 100) + 0.5, 0.51);
  }
  EXPECT_GT(n_seen, 2000u);
  EXPECT_EQ(CoarsePoints(points, 50'000).splat(splat, projection, options).cells,
            splat(points, projection, options).cells);
}

}  // namespace viewer_model_test
}  // namespace cmap
