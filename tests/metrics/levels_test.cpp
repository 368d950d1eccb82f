#include "cmap/metrics/levels.hpp"

#include <cmath>

#include "cmap/core/execution.hpp"
#include "cmap/spatial/within.hpp"
#include "metrics/measured.hpp"

namespace cmap {
namespace levels_test {

using test::number;

/// n x n points a step apart in a plane, in one color.
PointCloud grid(int n, float step_m, const Rgb8& color) {
  std::vector<Eigen::Vector3f> places;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) places.emplace_back(static_cast<float>(x) * step_m, static_cast<float>(y) * step_m, 0);
  }
  return test::cloud_of(places, std::vector<Rgb8>(places.size(), color));
}

TEST(Levels, FloorsOfAGridAreItsSteps) {
  const test::Clouds clouds{grid(20, 0.25f, {10, 20, 30}), test::two_sheets(10, 10).estimate};
  MetricOptions options = test::with_thresholds({0.5, 0.25, 0.2}, 1.0);
  EXPECT_EQ(number(test::with_levels(catalog::chamfer, clouds, options), "floor.value"), 0.5);
  EXPECT_EQ(number(test::with_levels(catalog::chamfer, clouds, options), "floor.n"), 400);
  EXPECT_EQ(number(test::with_levels(catalog::chamfer, clouds, options), "floor.se"), 0.0);
  EXPECT_EQ(number(test::with_levels(catalog::rmse, clouds, options), "floor.value"), 0.25);
  EXPECT_EQ(number(test::with_levels(catalog::overlap, clouds, options), "floor.value"), 1.0);
  const Record accuracy = test::with_levels(catalog::accuracy, clouds, options);
  EXPECT_EQ(number(accuracy, "per_threshold.0.floor.value"), 0.25);
  EXPECT_EQ(number(accuracy, "per_threshold.1.floor.value"), 0.25);
  EXPECT_TRUE(std::isnan(number(accuracy, "per_threshold.2.floor.value")));
  for (const Metric* share : {&catalog::fitness, &catalog::completeness, &catalog::f_score}) {
    const Record record = test::with_levels(*share, clouds, options);
    EXPECT_EQ(number(record, "per_threshold.1.floor.value"), 1.0);
    EXPECT_EQ(number(record, "per_threshold.2.floor.value"), 0.0);
  }
}

TEST(Levels, OwnPointIsLeftOutAmongCopies) {
  // Three copies of each: the nearest other entry is a copy.
  const test::Clouds clouds{test::painted_triplicates(200), test::two_sheets(10, 10).estimate};
  EXPECT_EQ(number(test::with_levels(catalog::chamfer, clouds), "floor.value"), 0.0);
  EXPECT_EQ(number(test::with_levels(catalog::color_distance, clouds), "floor.value"), 0.0);
}

TEST(Levels, ColorFloorIsThatOfTheNearestOtherPoint) {
  const test::Clouds clouds = test::two_sheets(500, 400);
  const PointCloud& map = clouds.reference;
  double sum = 0.0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    std::size_t nearest = i == 0 ? 1 : 0;
    for (std::size_t k = 0; k < map.size(); ++k) {
      if (k != i && (map.world(k) - map.world(i)).norm() < (map.world(nearest) - map.world(i)).norm()) nearest = k;
    }
    sum += (test::unit_color(map, i) - test::unit_color(map, nearest)).norm();
  }
  EXPECT_NEAR_RELATIVE(number(test::with_levels(catalog::color_distance, clouds), "floor.value"),
                       sum / static_cast<double>(map.size()), test::kSummation);
}

/// A gray in its first `n_white` points, black in the others.
PointCloud two_colored(PointCloud cloud, std::size_t n_white, std::uint8_t white) {
  auto& colors = std::get<Array<Rgb8>>(cloud.colors);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const std::uint8_t level = i < n_white ? white : std::uint8_t{0};
    colors[i] = {level, level, level};
  }
  return cloud;
}

TEST(Levels, ChanceOfTwoColors) {
  // The reference is black, a quarter of the estimate white: any draw is sqrt 3 off with probability 1/4.
  const PointCloud reference = two_colored(test::two_sheets(800, 1).reference, 0, 255);
  const PointCloud estimate = two_colored(test::two_sheets(1, 800).estimate, 200, 255);
  const test::Clouds clouds{reference, estimate};
  const double expected = 0.25 * std::sqrt(3.0);
  const Record cd = test::with_levels(catalog::color_distance, clouds);
  EXPECT_NEAR(number(cd, "chance.value"), expected, 1e-12);  // over all pairs of 800 x 800
  EXPECT_EQ(number(cd, "chance.se"), 0.0);
  EXPECT_NEAR(number(test::with_levels(catalog::color_fidelity, clouds), "chance.value"), -20 * std::log10(expected),
              1e-10);
  // Trace of the covariance of all colors: 3 x 1/4 x 3/4, with n - 1.
  EXPECT_NEAR(number(test::with_levels(catalog::color_consistency, clouds), "chance.value"), 3 * 0.1875 * 800 / 799.0,
              1e-12);
}

TEST(Levels, ChanceOfMoreColorsThanPairsIsSampled) {
  const PointCloud reference = two_colored(test::two_sheets(3000, 1).reference, 0, 255);
  const PointCloud estimate = two_colored(test::two_sheets(1, 3000).estimate, 750, 255);
  const Record cd = test::with_levels(catalog::color_distance, {reference, estimate});
  EXPECT_GT(number(cd, "chance.se"), 0.0);
  EXPECT_NEAR(number(cd, "chance.value"), 0.25 * std::sqrt(3.0), 5.0 * number(cd, "chance.se"));
}

TEST(Levels, ChanceOfRecall) {
  // Every reference point is black; k of its estimated points within the radius are white or black, as drawn:
  // 1 - (3/4)^k for a quarter of black ones.
  std::vector<Eigen::Vector3f> apart, around;
  for (int i = 0; i < 40; ++i) {
    apart.emplace_back(10.0f * static_cast<float>(i), 0, 0);
    for (int k = 0; k < 3; ++k) around.emplace_back(10.0f * static_cast<float>(i), 0.1f * static_cast<float>(k), 0);
  }
  const PointCloud reference = test::cloud_of(apart, std::vector<Rgb8>(40, {0, 0, 0}));
  PointCloud estimate = test::cloud_of(around, std::vector<Rgb8>(120, {0, 0, 0}));
  estimate = two_colored(estimate, 90, 255);
  const Record found = test::with_levels(catalog::local_color_recall, {reference, estimate});
  EXPECT_NEAR(number(found, "chance.value"), 1.0 - 0.75 * 0.75 * 0.75, 1e-12);
  EXPECT_EQ(number(found, "floor.value"), 0.0);  // no other reference point is near
  EXPECT_TRUE(std::isnan(number(found, "skill.value")));
}

TEST(Levels, RecallFloorCountsTheOtherPointsOfTheReference) {
  // Points a step of 0.25 apart in columns of one color: the neighbor in the column is right within 0.3, not within
  // 0.2.
  PointCloud reference = grid(20, 0.25f, {0, 0, 0});
  auto& colors = std::get<Array<Rgb8>>(reference.colors);
  for (std::size_t i = 0; i < colors.size(); ++i) colors[i] = (i / 20) % 2 == 0 ? Rgb8{0, 0, 0} : Rgb8{255, 255, 255};
  MetricOptions options;
  for (const auto& [radius_m, expected] : {std::pair{0.25, 1.0}, {0.2, 0.0}}) {
    options.lcr_radius_m = radius_m;
    const Record found = test::with_levels(catalog::local_color_recall, {reference, reference}, options);
    EXPECT_EQ(number(found, "floor.value"), expected);
  }
}

TEST(Levels, SkillSaysWhyItHasNone) {
  const auto levels_of = [](double floor, double se_floor, double chance) {
    Levels levels;
    levels.floor.value = floor;
    levels.floor.se = se_floor;
    levels.chance.value = chance;
    levels.chance.se = 0.0;
    return levels;
  };
  const auto reason = [](double value, const Levels& levels, std::string_view better = "lower") {
    const Level skill = skill_of(value, levels, better);
    EXPECT_TRUE(std::isnan(skill.value));
    return skill.reason;
  };
  const Levels good = levels_of(0.1, 0.0, 0.5);
  EXPECT_DOUBLE_EQ(skill_of(0.2, good, "lower").value, 0.75);
  EXPECT_DOUBLE_EQ(skill_of(0.6, good, "lower").value, -0.25);
  EXPECT_EQ(reason(0.2, good, "higher"), "the floor is no better than chance");
  EXPECT_EQ(reason(0.2, levels_of(0.1, 0.2, 0.5)), "the floor is no better than chance");
  EXPECT_FALSE(std::isnan(skill_of(0.2, levels_of(0.1, 0.19, 0.5), "lower").value));
  EXPECT_EQ(reason(NAN, good), "there is no value");
  EXPECT_EQ(reason(INFINITY, good, "higher"), "the value is infinite");
  Levels without_floor = good;
  without_floor.floor = Level{.reason = "none"};
  EXPECT_EQ(reason(0.2, without_floor), "there is no floor: none");
}

TEST(Levels, SkillsErrorIsThatOfItsLevels) {
  // d skill / d floor = (c - v) / (c - f)^2, d skill / d chance = (v - f) / (c - f)^2.
  Levels levels;
  levels.floor = {0.1, 0.01, 10};
  levels.chance = {0.5, 0.02, 10};
  const Level skill = skill_of(0.2, levels, "lower");
  EXPECT_DOUBLE_EQ(skill.se, std::hypot(0.3 / 0.16 * 0.01, 0.1 / 0.16 * 0.02));
}

TEST(Levels, OfAReferenceOfOnePointSayWhy) {
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}}, {{1, 2, 3}}), test::two_sheets(10, 10).estimate};
  const Record found = test::with_levels(catalog::color_distance, clouds);
  EXPECT_TRUE(std::isnan(number(found, "floor.value")));
  EXPECT_TRUE(std::isnan(number(found, "skill.value")));
}

TEST(Levels, AnIndependentSampleOfTheSurfaceHasSkillOne) {
  const auto painted = [](unsigned seed) {
    PointCloud cloud = test::sheet_cloud(50000, seed);
    test::paint(cloud, seed);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const auto level = static_cast<std::uint8_t>(127.0f + 120.0f * std::sin(3.0f * cloud.positions[i].x()));
      std::get<Array<Rgb8>>(cloud.colors)[i] = {level, level, level};
    }
    return cloud;
  };
  const Record found = test::with_levels(catalog::color_distance, {painted(1), painted(1001)});
  const double value_se = number(found, "floor.se");  // as many pairs, of the same spread
  const double span = number(found, "chance.value") - number(found, "floor.value");
  EXPECT_NEAR(number(found, "skill.value"), 1.0, 5.0 * std::hypot(number(found, "skill.se"), value_se / span) + 0.01);
}

TEST(Levels, SameBitsForAnyNumberOfThreads) {
  const test::Clouds clouds = test::two_sheets(150000, 50000);  // more than the sample
  const auto levels = [&] {
    std::vector<std::optional<double>> found;
    for (const Metric* metric : {&catalog::chamfer, &catalog::color_distance, &catalog::local_color_recall}) {
      const Record record = test::with_levels(*metric, clouds);
      for (const char* name : {"floor.value", "floor.n", "chance.value"}) found.push_back(record.number(name));
    }
    return found;
  };
  const auto many = levels();
  const ExecutionScope limit({.threads = 1});
  EXPECT_EQ(levels(), many);
  EXPECT_EQ(*many[1], 100000);
}

TEST(PointsWithin, CountsLikeTheDefinition) {
  const PointCloud cloud = test::sheet_cloud(5000, 1);
  const IndexedMap map(cloud);
  for (const double radius_m : {0.05, 0.7, 3.0, 100.0}) {
    const PointsWithin within(map.index, radius_m);
    for (std::size_t i = 0; i < cloud.size(); i += 97) {
      std::uint64_t expected = 0;
      for (std::size_t k = 0; k < cloud.size(); ++k) {
        expected += (cloud.world(k) - cloud.world(i)).norm() <= radius_m ? 1 : 0;
      }
      EXPECT_EQ(within.count(cloud.positions[i]), expected);
      EXPECT_TRUE(within.any(cloud.positions[i], i, [](std::size_t) { return true; }));
    }
    EXPECT_EQ(within.count({1e4f, 0, 0}), 0U);
  }
}

}  // namespace levels_test
}  // namespace cmap
