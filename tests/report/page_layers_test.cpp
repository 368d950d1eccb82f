#include "page_layers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "metrics/map_pairs.hpp"

namespace cmap {
namespace page_layers_test {

using ::testing::ElementsAre;

TEST(RecallLayer, SharesAreTheMetrics) {
  LocalColorRecall recall;
  recall.classes = {RecallClass::kRecalled, RecallClass::kNoColor, RecallClass::kRecalled, RecallClass::kWrongColor,
                    RecallClass::kNotCovered};
  const auto layer = recall_layer(recall);
  const auto& classes = layer.at("classes");
  ASSERT_EQ(classes.size(), 4u);
  const auto is = [&](std::size_t i, const char* label, std::uint64_t points, const nlohmann::ordered_json& share) {
    EXPECT_EQ(classes[i].at("label"), label);
    EXPECT_EQ(classes[i].at("points"), points) << label;
    EXPECT_EQ(classes[i].at("share"), share) << label;
  };
  is(0, "not covered", 1, 0.25);
  is(1, "wrong color", 1, 0.25);
  is(2, "recalled", 2, 0.5);
  is(3, "no color of its own", 1, nullptr);
}

TEST(RecallLayer, WhereEveryPointHasAColorThereAreThreeClasses) {
  LocalColorRecall recall;
  recall.classes = {RecallClass::kNotCovered};
  EXPECT_EQ(recall_layer(recall).at("classes").size(), 3u);
}

TEST(DistanceLayer, RanksTheErrorsOfEveryPoint) {
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {50, 0, 0}, {0, 50, 0}}),
                            test::cloud_of({{0, 0, 0.5f}, {50, 0, 0.1f}, {0, 50, 2}})};
  const MapPair pair = clouds.pair();
  const auto layer = distance_layer(distribution_of(pair, &NearestPairs::distance_m));
  EXPECT_EQ(layer.at("ranked").at("points"), 3);
  EXPECT_THAT(layer.at("ranked").at("values"), ElementsAre(0.1, 0.5, 2.0)) << "0.1 as typed, not as a float";
}

TEST(ColorDistanceLayer, RanksPointsThatHaveAColor) {
  test::Clouds clouds{test::cloud_of({{0, 0, 0}, {50, 0, 0}}), test::cloud_of({{0, 0, 0}, {50, 0, 0}})};
  clouds.reference.colors = Array<RgbF>{{0, 0, 0}, {NAN, NAN, NAN}};
  clouds.estimate.colors = Array<RgbF>{{1, 0, 0}, {1, 1, 1}};
  const MapPair pair = clouds.pair();
  const auto layer = color_distance_layer(distribution_of(pair, &NearestPairs::color_distance));
  EXPECT_EQ(layer.at("ranked").at("points"), 1);
  EXPECT_THAT(layer.at("ranked").at("values"), ElementsAre(1.0));
}

TEST(HeightLayer, ColorsTheMiddle98PercentOfThePoints) {
  PointCloud cloud;
  for (int i = 0; i <= 100; ++i) cloud.positions.push_back({static_cast<float>(i), 0, static_cast<float>(i)});
  const auto layer = height_layer(IndexedMap(cloud), "estimate", "Height");
  EXPECT_THAT(layer.at("range"), ElementsAre(1.0, 99.0));
  EXPECT_EQ(layer.at("ranked").at("points"), 101);
}

TEST(HeightLayer, OfALevelMapIsARangeAllTheSame) {
  const auto layer = height_layer(IndexedMap(test::cloud_of({{0, 0, 5}, {1, 0, 5}})), "estimate", "Height");
  EXPECT_THAT(layer.at("range"), ElementsAre(5.0, 6.0));
}

}  // namespace page_layers_test
}  // namespace cmap
