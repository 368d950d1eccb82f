#include "packed_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "cmap/core/parallel.hpp"
#include "metrics/map_pairs.hpp"

namespace cmap {
namespace packed_map_test {

using ::testing::ElementsAre;

Array<std::uint32_t> all_slots(const MapPair& pair) {
  Array<std::uint32_t> slots(pair.reference.size());
  std::iota(slots.begin(), slots.end(), 0u);
  return slots;
}

/// Two reference points, 300 mm apart along x, in Hilbert order; the estimate lies 4 m and 1 m above them.
TEST(PackMap, HandComputed) {
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {0.3f, 0, 0}}, {{10, 0, 255}, {8, 0, 0}}),
                            test::cloud_of({{0.3f, 0, 1}}, {{8, 0, 0}})};
  const MapPair pair = clouds.pair();
  ASSERT_EQ(pair.reference.index.points.original_index[0], 0u);
  LocalColorRecall recall;
  recall.classes = {RecallClass::kNotCovered, RecallClass::kRecalled};
  const PackedMap packed = pack_map(pair.reference_to_estimate(), &recall, all_slots(pair));

  const auto& description = packed.description;
  EXPECT_EQ(description.at("points"), 2);
  EXPECT_EQ(description.at("points_of_map"), 2);
  ASSERT_EQ(description.at("grids").size(), 1u);
  EXPECT_EQ(description.at("grids")[0].at("points"), 2);
  EXPECT_THAT(description.at("grids")[0].at("origin_m"), ElementsAre(0.0, 0.0, 0.0));
  // A ten thousandth of 0.3 m is 3e-5 m; the power of ten below it is taken.
  EXPECT_THAT(description.at("grids")[0].at("step_m"), ElementsAre(1e-5, 1e-5, 1e-5));
  std::string fields;
  for (const auto& plane : description.at("planes")) {
    fields += plane.at("field").get<std::string>() + " " + plane.at("type").get<std::string>() + " ";
  }
  EXPECT_EQ(fields, "x u24 y u24 z u24 r u8 g u8 b u8 distance u16 color_distance u16 lcr u8 ");

  const double farther_m = std::sqrt(1.0 + static_cast<double>(0.3f) * static_cast<double>(0.3f));
  EXPECT_DOUBLE_EQ(description.at("planes")[6].at("max")[0].get<double>(), farther_m);
  // 0 and 30000: zig-zag of the differences 0 and 60000 = 0xea60, low bytes, middle bytes, high bytes.
  const std::string x{"\x00\x60\x00\xea\x00\x00", 6};
  const std::string y(6, '\0'), z(6, '\0');
  const std::string r{"\x14\x03", 2};  // 10, then -2
  const std::string g(2, '\0');
  const std::string b{"\x01\x02", 2};  // 255 is -1; from there to 0 it is 1, modulo 256
  // The farther one is 65534, or -2: zig-zag 3; the other one round(65534 sqrt(1 / 1.04403)) = 64137, so -1397: 2793.
  const std::string distance{"\x03\xe9\x00\x0a", 4};
  EXPECT_EQ(packed.bytes.substr(0, 6), x);
  EXPECT_EQ(packed.bytes.substr(6, 12), y + z);
  EXPECT_EQ(packed.bytes.substr(18, 6), r + g + b);
  EXPECT_EQ(packed.bytes.substr(24, 4), distance);
  EXPECT_EQ(packed.bytes.substr(32), std::string("\x00\x04", 2)) << "class 0, then 2";
}

TEST(PackMap, WithoutColorThereAreOnlyPositionsAndDistances) {
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}}), test::cloud_of({{0, 0, 0}}, {{1, 2, 3}})};
  const MapPair pair = clouds.pair();
  const PackedMap packed = pack_map(pair.reference_to_estimate(), nullptr, all_slots(pair));
  EXPECT_EQ(packed.description.at("planes").size(), 4u);
  EXPECT_EQ(packed.bytes.size(), 3u * 3u + 2u);
}

TEST(PackMap, AnErrorThatIsNotThereHasTheLastCode) {
  test::Clouds clouds{test::cloud_of({{0, 0, 0}}), test::cloud_of({{0, 0, 0}}, {{1, 2, 3}})};
  clouds.reference.colors = Array<RgbF>{{NAN, NAN, NAN}};
  const MapPair pair = clouds.pair();
  const PackedMap packed = pack_map(pair.reference_to_estimate(), nullptr, all_slots(pair));
  EXPECT_EQ(packed.description.at("planes").back().at("field"), "color_distance");
  EXPECT_EQ(packed.bytes.substr(packed.bytes.size() - 2), std::string("\x01\x00", 2)) << "65535 is -1: zig-zag 1";
}

TEST(PackMap, OneMapHasPositionsAndColors) {
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {0.3f, 0, 0}}, {{10, 0, 255}, {8, 0, 0}}),
                            test::cloud_of({{0, 0, 0}})};
  const MapPair pair = clouds.pair();
  const PackedMap alone = pack_map(pair.reference, all_slots(pair));
  EXPECT_EQ(alone.description.at("planes").size(), 6u);
  const PackedMap of_pair = pack_map(pair.reference_to_estimate(), nullptr, all_slots(pair));
  EXPECT_EQ(of_pair.bytes.substr(0, alone.bytes.size()), alone.bytes);
  EXPECT_EQ(alone.bytes.size(), 2u * (3u * 3u + 3u));
}

TEST(PackMap, AWideMapHasWiderSteps) {
  const test::Clouds clouds{test::cloud_of({{0, 0, 0}, {1e6f, 0, 0}}), test::cloud_of({{0, 0, 0}})};
  const MapPair pair = clouds.pair();
  const PackedMap packed = pack_map(pair.reference_to_estimate(), nullptr, all_slots(pair));
  const auto& step_m = packed.description.at("grids")[0].at("step_m");
  EXPECT_DOUBLE_EQ(step_m[0].get<double>(), 1e6 / 16777215.0);
  EXPECT_DOUBLE_EQ(step_m[1].get<double>(), 1e-3) << "each axis its own";
}

/// A sheet of 100 x 100 points, `spacing_m` apart.
PointCloud sheet(float spacing_m) {
  PointCloud cloud;
  for (int i = 0; i < 10'000; ++i) {
    cloud.positions.push_back({spacing_m * static_cast<float>(i % 100), spacing_m * static_cast<float>(i / 100), 0});
  }
  return cloud;
}

TEST(PackMap, ASmallObjectHasSmallSteps) {
  const test::Clouds clouds{sheet(2e-4f), sheet(2e-4f)};
  const MapPair pair = clouds.pair();
  const PackedMap packed = pack_map(pair.reference, all_slots(pair));
  EXPECT_THAT(packed.description.at("grids")[0].at("step_m"), ElementsAre(1e-6, 1e-6, 1e-6)) << "2 cm / 10,000";
}

TEST(PackMap, StraysComeLastInAGridOfTheirOwn) {
  PointCloud strayed = sheet(0.1f);
  for (const float x : {5e8f, -2e6f}) strayed.positions.insert(strayed.positions.begin() + 5000, {x, 0, 0});
  const test::Clouds clouds{strayed, sheet(0.1f)};
  const MapPair pair = clouds.pair();
  const PackedMap packed = pack_map(pair.reference_to_estimate(), nullptr, all_slots(pair));
  const auto& grids = packed.description.at("grids");
  ASSERT_EQ(grids.size(), 2u);
  EXPECT_EQ(grids[0].at("points"), 10'000);
  EXPECT_THAT(grids[0].at("step_m"), ElementsAre(1e-3, 1e-3, 1e-3));
  EXPECT_EQ(grids[1].at("points"), 2);
  EXPECT_DOUBLE_EQ(grids[1].at("origin_m")[0].get<double>(), -2e6);
  EXPECT_DOUBLE_EQ(grids[1].at("step_m")[0].get<double>(), 5.02e8 / 16777215.0);
  // Nor do their errors coarsen those of the others, which lie where the estimate has its points.
  const auto& most = packed.description.at("planes")[3].at("max");
  EXPECT_EQ(most[0], 0.0);
  EXPECT_NEAR(most[1].get<double>(), 5e8, 100.0);
}

TEST(PackMap, TenDiagonalsAwayIsNoStray) {
  PointCloud cloud = sheet(0.1f);  // the middle 98 % have a diagonal of 13.7 m
  cloud.positions.push_back({0, 0, -130});
  const test::Clouds clouds{cloud, cloud};
  const MapPair pair = clouds.pair();
  EXPECT_EQ(pack_map(pair.reference, all_slots(pair)).description.at("grids").size(), 1u);
}

}  // namespace packed_map_test
}  // namespace cmap
