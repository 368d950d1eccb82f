#include "cmap/render/layer.hpp"

#include "eval/eval_testing.hpp"

namespace cmap {
namespace layer_test {

using ::testing::HasSubstr;

/// Floats published with matplotlib, such as 0.993248, 0.906157, 0.143936 for the end of viridis, times 255, rounded.
TEST(ColorTable, EndsAreThoseOfThePublishedMaps) {
  EXPECT_EQ(color_table(ColorMap::kViridis)[0], (Rgb8{68, 1, 84}));
  EXPECT_EQ(color_table(ColorMap::kViridis)[255], (Rgb8{253, 231, 37}));
  EXPECT_EQ(color_table(ColorMap::kInferno)[0], (Rgb8{0, 0, 4}));
  EXPECT_EQ(color_table(ColorMap::kInferno)[255], (Rgb8{252, 255, 164}));
  EXPECT_EQ(color_table(ColorMap::kCividis)[0], (Rgb8{0, 34, 78}));
  EXPECT_EQ(color_table(ColorMap::kTurbo)[0], (Rgb8{48, 18, 59}));
}

TEST(ColorOf, ClampsAndKnowsNoValue) {
  const ColorScale linear{2.0, 4.0, false, ColorMap::kViridis, "m"};
  const auto& table = color_table(ColorMap::kViridis);
  EXPECT_EQ(color_of(2.0, linear), table[0]);
  EXPECT_EQ(color_of(-1.0, linear), table[0]);
  EXPECT_EQ(color_of(4.0, linear), table[255]);
  EXPECT_EQ(color_of(INFINITY, linear), table[255]);
  EXPECT_EQ(color_of(2.4, linear), table[51]);
  EXPECT_EQ(color_of(NAN, linear), (Rgb8{160, 160, 160}));
  const ColorScale logarithmic{0.01, 1.0, true, ColorMap::kViridis, "m"};
  EXPECT_EQ(color_of(0.0, logarithmic), table[0]);
  EXPECT_EQ(color_of(0.1, logarithmic), table[128]);  // 127.5 rounds away from zero
}

/// A recalled point, one of the wrong color, one without cover.
EvaluatedPair three_points() {
  return evaluate(test::small_map({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}, {{200, 0, 0}, {0, 200, 0}, {0, 0, 200}}),
                  test::small_map({{0, 0, 0}, {10, 0, 0.25f}}, {{200, 0, 0}, {0, 0, 0}}),
                  test::options_for({"chamfer", "color_distance", "local_color_recall"}));
}

Rgb8 color_at_x(const Layer& layer, double x) {
  for (std::size_t slot = 0; slot < layer.points->size; ++slot) {
    if (layer.points->world(slot).x() == x) return layer.colors[slot];
  }
  return {};
}

TEST(MakeLayer, RecallHasItsThreeClasses) {
  const EvaluatedPair evaluation = three_points();
  const Layer layer = make_layer(evaluation, "lcr");
  EXPECT_EQ(color_at_x(layer, 0.0), (Rgb8{0, 114, 178}));
  EXPECT_EQ(color_at_x(layer, 10.0), (Rgb8{213, 94, 0}));
  EXPECT_EQ(color_at_x(layer, 20.0), (Rgb8{187, 187, 187}));
  ASSERT_EQ(layer.classes.size(), 3u);
  EXPECT_EQ(layer.classes[0].label, "recalled");
  EXPECT_EQ(layer.classes[0].color, (Rgb8{0, 114, 178}));
  EXPECT_EQ(layer.classes[1].label, "wrong color");
  EXPECT_EQ(layer.classes[1].color, (Rgb8{213, 94, 0}));
  EXPECT_EQ(layer.caption, "LCR 33.3 %");
}

TEST(MakeLayer, HeatMapsShowTheirValues) {
  const EvaluatedPair evaluation = three_points();
  const LayerOptions to_half{{{0.0, 0.5}}, ColorMap::kTurbo, false};
  const Layer distance = make_layer(evaluation, "distance", to_half);
  EXPECT_EQ(distance.points, &evaluation.pair.estimate.index.points);
  EXPECT_EQ(color_at_x(distance, 0.0), color_table(ColorMap::kTurbo)[0]);
  EXPECT_EQ(color_at_x(distance, 10.0), color_table(ColorMap::kTurbo)[128]);  // 0.25 m of 0.5 m
  const Layer color = make_layer(evaluation, "color-distance", {{{0.0, 1.0}}, std::nullopt, false});
  EXPECT_EQ(color_at_x(color, 0.0), color_table(ColorMap::kInferno)[0]);
  EXPECT_EQ(color_at_x(color, 10.0), color_table(ColorMap::kInferno)[200]);  // 200 / 255
}

TEST(MakeLayer, VoxelsPaintTheirPoints) {
  EvaluationOptions options = test::options_for({"chamfer"});
  options.ccs_voxel_m = 1.0;
  options.awd_voxel_m = 1.0;
  options.awd_min_points = 2;
  options.cw_min_points = 2;
  // Two points in one voxel and one in another; the estimate lies 0.25 m higher.
  const std::vector<Rgb8> colors{{0, 0, 0}, {255, 0, 0}, {9, 9, 9}};
  const PointCloud reference =
      test::small_map({{0.25f, 0.5f, 0.25f}, {0.75f, 0.5f, 0.25f}, {5.5f, 0.5f, 0.25f}}, colors);
  const PointCloud estimate = test::small_map({{0.25f, 0.5f, 0.5f}, {0.75f, 0.5f, 0.5f}, {5.5f, 0.5f, 0.5f}}, colors);
  const EvaluatedPair evaluation = evaluate(reference, estimate, options);
  const Rgb8 none{160, 160, 160};
  const Layer spread = make_layer(evaluation, "ccs", {{{0.0, 1.0}}, std::nullopt, false});
  EXPECT_EQ(color_at_x(spread, 0.25), color_table(ColorMap::kInferno)[128]);  // variance of 0 and 1: 0.5
  EXPECT_EQ(color_at_x(spread, 0.75), color_table(ColorMap::kInferno)[128]);
  EXPECT_EQ(color_at_x(spread, 5.5), color_table(ColorMap::kInferno)[0]) << "a single point counts as 0";
  options.ccs_singletons = Singletons::kExclude;
  const EvaluatedPair excluding = evaluate(reference, estimate, options);
  EXPECT_EQ(color_at_x(make_layer(excluding, "ccs"), 5.5), none);
  const Layer distance = make_layer(evaluation, "wasserstein", {{{0.0, 0.5}}, std::nullopt, false});
  EXPECT_EQ(color_at_x(distance, 0.75), color_table(ColorMap::kViridis)[128]);  // 0.25 m of 0.5 m
  EXPECT_EQ(color_at_x(distance, 5.5), none);
  const Layer colors_of_voxels = make_layer(evaluation, "color-wasserstein", {{{0.0, 0.5}}, std::nullopt, false});
  EXPECT_EQ(color_at_x(colors_of_voxels, 0.75), color_table(ColorMap::kInferno)[0]);  // the same colors
  EXPECT_EQ(color_at_x(colors_of_voxels, 5.5), none);
  const Layer density = make_layer(evaluation, "density", {{{0.0, 2.0}}, std::nullopt, false});
  EXPECT_EQ(color_at_x(density, 0.75), color_table(ColorMap::kViridis)[255]);  // two points of two
  EXPECT_EQ(color_at_x(density, 5.5), color_table(ColorMap::kViridis)[128]);
}

TEST(MakeLayer, PointsWithoutColorHaveNoValue) {
  PointCloud reference = test::small_map({{0, 0, 0}, {10, 0, 0}}), estimate = reference;
  reference.colors = Array<RgbF>{{0, 0, 0}, {NAN, NAN, NAN}};
  estimate.colors = Array<RgbF>{{0, 0, 0}, {1, 1, 1}};
  const EvaluatedPair evaluation = evaluate(reference, estimate, test::options_for({"color"}));
  const Rgb8 none{160, 160, 160};
  for (const char* name : {"color-distance", "delta-e"}) {
    EXPECT_NE(color_at_x(make_layer(evaluation, name), 0.0), none) << name;
    EXPECT_EQ(color_at_x(make_layer(evaluation, name), 10.0), none) << name;
  }
  const Layer recall = make_layer(evaluation, "lcr");
  ASSERT_EQ(recall.classes.size(), 4u);
  EXPECT_EQ(recall.classes[3].label, "no color of its own");
  EXPECT_EQ(color_at_x(recall, 10.0), recall.classes[3].color);
}

TEST(MakeLayer, MapsKeepTheirColors) {
  const EvaluatedPair evaluation = three_points();
  EXPECT_EQ(color_at_x(make_layer(evaluation, "reference"), 20.0), (Rgb8{0, 0, 200}));
  EXPECT_EQ(color_at_x(make_layer(evaluation, "estimate"), 10.0), (Rgb8{0, 0, 0}));
}

TEST(MakeLayer, RefusesWhatTheDataCannotGive) {
  const EvaluatedPair plain =
      evaluate(test::small_map({{0, 0, 0}}), test::small_map({{0, 0, 1}}), test::options_for({"chamfer"}));
  for (const char* name : {"lcr", "color-distance", "delta-e", "ccs"}) {
    EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { make_layer(plain, name); }), HasSubstr(name));
  }
  EXPECT_THAT(test::refusal_of<UsageError>([&] { make_layer(plain, "colour"); }),
              HasSubstr("layer \"colour\" is unknown; layers are reference, estimate, lcr"));
  EXPECT_TRUE(make_layer(plain, "reference").scale.has_value()) << "height in place of color";
}

}  // namespace layer_test
}  // namespace cmap
