#include "cmap/render/point_text.hpp"

#include "eval/eval_testing.hpp"

namespace cmap {
namespace point_text_test {

using ::testing::ElementsAre;

TEST(DescribePoint, OfOneMap) {
  PointCloud cloud = test::small_map({{1, 2, 3}}, {{10, 20, 255}});
  cloud.origin = {1e6, 0, 0};
  EXPECT_THAT(describe_point(IndexedMap(cloud), 0),
              ElementsAre("x 1000001.000  y 2.000  z 3.000 m", "color 10 20 255 of 255"));
  EXPECT_THAT(describe_point(IndexedMap(test::small_map({{1, 2, 3}})), 0), ElementsAre("x 1.000  y 2.000  z 3.000 m"));
}

TEST(DescribePoint, OfAPair) {
  const EvaluatedPair evaluation =
      evaluate(test::small_map({{0, 0, 0}}, {{0, 0, 0}}), test::small_map({{0, 0, 0.25f}}, {{51, 0, 0}}),
               test::options_for({"chamfer", "local_color_recall"}));
  EXPECT_THAT(
      describe_point(evaluation, evaluation.pair.reference.index.points, 0),
      ElementsAre("point of the reference", "x 0.000  y 0.000  z 0.000 m", "color 0 0 0 of 255",
                  "distance to the estimate 0.25 m", "color distance 0.2 unit RGB", "local color recall: recalled"));
  EXPECT_THAT(describe_point(evaluation, evaluation.pair.estimate.index.points, 0),
              ElementsAre("point of the estimate", "x 0.000  y 0.000  z 0.250 m", "color 51 0 0 of 255",
                          "distance to the reference 0.25 m", "color distance 0.2 unit RGB"));
}

}  // namespace point_text_test
}  // namespace cmap
