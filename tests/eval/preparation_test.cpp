#include "preparation.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "cmap/eval/map_error.hpp"
#include "cmap/geometry/color.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace preparation_test {

using test::gray_map;
using test::kNone;
using test::refusal_of;
using test::small_map;
using test::warning_ids;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Both maps as they are compared.
struct Prepared {
  PointCloud reference, estimate;
  std::vector<Warning> warnings;
};

Prepared prepared(PointCloud reference, PointCloud estimate, const EvaluationOptions& options = {},
                  const Eigen::Matrix4d& T_ref_est = Eigen::Matrix4d::Identity()) {
  Prepared result{std::move(reference), std::move(estimate), {}};
  prepare_clouds(result.reference, result.estimate, options, select_metrics(options), T_ref_est, result.warnings);
  return result;
}

Eigen::Matrix4d turn_left_and_shift(double dx) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<2, 2>() << 0, -1, 1, 0;
  T(0, 3) = dx;
  return T;
}

const PointCloud kCorners = gray_map({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 4}});

TEST(Preparation, LeavesMapsOfOneFrameAlone) {
  const Prepared maps = prepared(kCorners, kCorners);
  EXPECT_EQ(maps.reference.positions, kCorners.positions);
  EXPECT_EQ(maps.estimate.positions, kCorners.positions);
  EXPECT_EQ(warning_ids(maps.warnings), kNone);
}

TEST(Preparation, MovesTheEstimateIntoTheReferenceFrame) {
  const Prepared maps = prepared(kCorners, gray_map({{1, 2, 3}, {3, 1, 0}}), {}, turn_left_and_shift(3));
  EXPECT_EQ(maps.estimate.world(0), Eigen::Vector3d(1, 1, 3));
  EXPECT_EQ(maps.estimate.world(1), Eigen::Vector3d(2, 3, 0));
  EXPECT_EQ(maps.reference.positions, kCorners.positions);
}

TEST(Preparation, CropsBothMapsBordersIncluded) {
  EvaluationOptions options;
  options.crop = Box3d{{0, 0, 0}, {4, 4, 3}};
  const Prepared maps = prepared(kCorners, gray_map({{4, 4, 3}, {2, 2, 3.5f}, {-1, 0, 0}}), options);
  EXPECT_EQ(maps.reference.size(), 3U);
  ASSERT_EQ(maps.estimate.size(), 1U);
  EXPECT_EQ(maps.estimate.world(0), Eigen::Vector3d(4, 4, 3));
}

TEST(Preparation, CropsAfterTheTransform) {
  EvaluationOptions options;
  options.crop = Box3d{{-0.5, -0.5, -0.5}, {4.5, 4.5, 4.5}};
  // (100, 0, 0) turns to (0, 100, 0), (1, 100, 0) to (0, 1, 0).
  const Prepared maps = prepared(kCorners, gray_map({{100, 0, 0}, {1, 100, 0}}), options, turn_left_and_shift(100));
  ASSERT_EQ(maps.estimate.size(), 1U);
  EXPECT_EQ(maps.estimate.world(0), Eigen::Vector3d(0, 1, 0));
}

TEST(Preparation, ACropThatLeavesNothingIsUnsupported) {
  EvaluationOptions options;
  options.crop = Box3d{{3.5, 3.5, 3.5}, {9, 9, 9}};
  const PointCloud elsewhere = gray_map({{0, 0, 0}});
  EXPECT_THAT(refusal_of<UnsupportedError>([&] { prepared(kCorners, elsewhere, options); }),
              HasSubstr("crop: no point of the estimate is inside"));
  EXPECT_THAT(refusal_of<UnsupportedError>([&] { prepared(elsewhere, kCorners, options); }),
              HasSubstr("crop: no point of the reference is inside"));
}

TEST(Preparation, ThinsBothMapsToTheMeanOfEveryVoxel) {
  EvaluationOptions options;
  options.voxel_m = 1.0;
  const PointCloud map = small_map({{0.25f, 0.5f, 0.5f}, {5, 5, 5}, {0.75f, 0.5f, 0.5f}},
                                   {Rgb8{10, 20, 30}, Rgb8{1, 2, 3}, Rgb8{20, 30, 50}});
  const Prepared maps = prepared(map, map, options);
  for (const PointCloud& thinned : {maps.reference, maps.estimate}) {
    ASSERT_EQ(thinned.size(), 2U);
    EXPECT_EQ(thinned.world(0), Eigen::Vector3d(0.5, 0.5, 0.5));
    EXPECT_EQ(thinned.world(1), Eigen::Vector3d(5, 5, 5));
    const RgbF color = rgb_255(thinned.colors, 0);
    for (auto [channel, expected] : {std::pair{0, 15.0f}, {1, 25.0f}, {2, 40.0f}}) {
      EXPECT_NEAR(color[static_cast<std::size_t>(channel)], expected, 1e-4f);
    }
  }
}

TEST(Preparation, CropsBeforeItThins) {
  EvaluationOptions options;
  options.voxel_m = 10.0;
  options.crop = Box3d{{0, 0, 0}, {1, 1, 1}};
  const PointCloud map = gray_map({{0.5f, 0.5f, 0.5f}, {9, 9, 9}});
  EXPECT_EQ(prepared(map, map, options).reference.world(0), Eigen::Vector3d(0.5, 0.5, 0.5));
}

TEST(Preparation, PutsBothMapsOnOneOrigin) {
  PointCloud reference = kCorners, estimate = kCorners;
  reference.origin = {500000, 4000000, 100};
  estimate.origin = {500001, 4000002, 103};
  const Prepared maps = prepared(reference, estimate);
  EXPECT_EQ(maps.reference.origin, maps.estimate.origin);
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    EXPECT_EQ(maps.reference.world(i), reference.world(i));
    EXPECT_EQ(maps.estimate.world(i), estimate.world(i));
  }
}

TEST(Preparation, MapsFarApartKeepTheirOriginsAndSaySo) {
  PointCloud estimate = kCorners;
  estimate.origin = {1e6, 0, 0};
  const Prepared maps = prepared(kCorners, estimate);
  EXPECT_EQ(maps.estimate.positions, kCorners.positions) << "offsets are not rounded";
  EXPECT_THAT(warning_ids(maps.warnings), ElementsAre("units_or_frame_mismatch", "precision_reduced"));
  EXPECT_THAT(maps.warnings[1].message, HasSubstr("1000 km apart"));
}

TEST(Preparation, WarnsOfBoxesApart) {
  const Prepared maps = prepared(kCorners, gray_map({{8, 0, 0}, {12, 4, 4}}));
  ASSERT_THAT(warning_ids(maps.warnings), ElementsAre("units_or_frame_mismatch"));
  EXPECT_THAT(maps.warnings[0].message, HasSubstr("4 m apart"));
}

/// A hundred points of a square meter, and one that may be far from them.
PointCloud square_with(const Eigen::Vector3f& last) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 100; ++i)
    points.emplace_back(0.1f * static_cast<float>(i % 10), 0.1f * static_cast<float>(i / 10), 0.0f);
  points.push_back(last);
  return gray_map(points);
}

TEST(Preparation, PutsTheOriginWhereThePointsAreWhateverOneStrayDoes) {
  // The whole box would give (1000000, 0, 0), about which floats have steps of 1/16 m.
  const Prepared maps = prepared(square_with({0, 0, 0}), square_with({1e6f, 0, 0}));
  EXPECT_EQ(maps.estimate.origin, Eigen::Vector3d(0, 0, 0));
}

TEST(Preparation, NamesThePointThatIsTooFarToCountVoxels) {
  for (const Eigen::Vector3f& far : {Eigen::Vector3f(5e8f, 0, 0), Eigen::Vector3f(0, 0, -9e8f)}) {
    const auto estimate = [&] { prepared(square_with({0, 0, 0}), square_with(far)); };
    EXPECT_THAT(refusal_of<MapError>(estimate), HasSubstr("the estimate: point 101 of 101, at ("));
    const auto reference = [&] { prepared(square_with(far), square_with({0, 0, 0})); };
    EXPECT_THAT(refusal_of<MapError>(reference), HasSubstr("the reference: point 101 of 101, at ("));
  }
}

TEST(Preparation, FarPointsWithoutColorNeedNoVoxelsOfIt) {
  PointCloud bare = square_with({5e8f, 0, 0});
  bare.colors = {};
  EXPECT_NO_THROW(prepared(square_with({0, 0, 0}), bare));
}

TEST(Preparation, VoxelsThatNobodyChoseAreNotToBlame) {
  const PointCloud wide = gray_map({{0, 0, 0}, {6e8f, 0, 0}});
  EXPECT_THAT(refusal_of<MapError>([&] { prepared(kCorners, wide); }), HasSubstr("are they in meters?"));
  EvaluationOptions options;
  options.ccs_voxel_m = 0.01;
  EXPECT_THAT(refusal_of<UsageError>([&] { prepared(kCorners, wide, options); }), HasSubstr("ccs-voxel: "));
}

TEST(Preparation, OnePointMapsAreMaps) {
  EXPECT_EQ(warning_ids(prepared(gray_map({{1, 2, 3}}), gray_map({{1, 2, 3}})).warnings), kNone);
}

TEST(Preparation, RefusesAMapWithoutPoints) {
  EXPECT_THAT(refusal_of<InputError>([] { prepared({}, kCorners); }), HasSubstr("the reference has no points"));
  EXPECT_THAT(refusal_of<InputError>([] { prepared(kCorners, {}); }), HasSubstr("the estimate has no points"));
}

TEST(Preparation, RefusesAPointThatIsNotFinite) {
  for (float bad : {NAN, INFINITY, -INFINITY}) {
    const PointCloud broken = gray_map({{0, 0, 0}, {0, bad, 0}});
    EXPECT_THAT(refusal_of<InputError>([&] { prepared(broken, kCorners); }),
                HasSubstr("the reference has a point that is not finite"));
    EXPECT_THAT(refusal_of<InputError>([&] { prepared(kCorners, broken); }),
                HasSubstr("the estimate has a point that is not finite"));
  }
}

TEST(Prepare, ATransformToWhereNoMapIsIsRefused) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  for (const double far_m : {1e9, 1e60}) {
    T(0, 3) = far_m;
    const std::string says = refusal_of<UnsupportedError>([&] { prepared(kCorners, kCorners, {}, T); });
    EXPECT_THAT(says, HasSubstr("the transform moves the estimate to coordinates of 1e+"));
  }
  T(0, 3) = 1e7;
  EXPECT_NO_THROW(prepared(kCorners, kCorners, {}, T));
}

TEST(Prepare, BlocksTooSmallAreRefusedByName) {
  EvaluationOptions options = test::options_for({"chamfer"});
  options.block_m = 1e-9;
  EXPECT_NO_THROW(prepared(kCorners, kCorners, options));
  options.bootstrap = 10;
  EXPECT_THAT(refusal_of<UsageError>([&] { prepared(kCorners, kCorners, options); }), ::testing::StartsWith("block: "));
}

}  // namespace preparation_test
}  // namespace cmap
