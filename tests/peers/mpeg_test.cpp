#include "cmap/peers/mpeg.hpp"

#include <cmath>

#include "metrics/map_pairs.hpp"

namespace cmap {
namespace mpeg_test {

MpegCloud mpeg_cloud(const PointCloud& cloud) {
  const auto& colors = std::get<Array<Rgb8>>(cloud.colors);
  return {{cloud.positions.begin(), cloud.positions.end()}, {colors.begin(), colors.end()}};
}

MpegDistortion distortion(const PointCloud& reference, const PointCloud& estimate) {
  return mpeg_distortion(mpeg_cloud(reference), mpeg_cloud(estimate));
}

constexpr Rgb8 kBlack{0, 0, 0};
constexpr Rgb8 kWhite{255, 255, 255};

/// Luma of a gray level and its squared difference to black, rounded to floats as the tool does.
double sq_luma(int gray) {
  const auto luma = static_cast<float>(gray / 255.0);
  return static_cast<double>(luma * luma);
}

/// Floats of luma or chroma, about 1, are rounded to 6e-8; squares of differences to twice that.
constexpr double kFloatColor = 1.5e-7;

TEST(Mpeg, HandComputed) {
  const PointCloud reference = test::cloud_of({{0, 0, 0}, {10, 0, 0}}, {kBlack, kWhite});
  const PointCloud estimate = test::cloud_of({{0, 3, 4}}, {{51, 51, 51}});
  const MpegDistortion d = distortion(reference, estimate);
  EXPECT_EQ(d.estimate_to_reference.point_mse_m2, 25.0);
  EXPECT_EQ(d.estimate_to_reference.sq_hausdorff_m2, 25.0);
  EXPECT_EQ(d.reference_to_estimate.point_mse_m2, (25.0 + 125.0) / 2.0);
  EXPECT_EQ(d.reference_to_estimate.sq_hausdorff_m2, 125.0);
  EXPECT_NEAR(d.estimate_to_reference.color_mse[0], 0.04, kFloatColor);
  EXPECT_NEAR(d.reference_to_estimate.color_mse[0], (0.04 + 0.64) / 2.0, kFloatColor);
  EXPECT_NEAR(d.reference_to_estimate.color_psnr_db[0], -10.0 * std::log10(0.34), 1e-5);
}

TEST(Mpeg, ChromaOfPureColors) {
  const MpegDirection red =
      distortion(test::cloud_of({{0, 0, 0}}, {{255, 0, 0}}), test::cloud_of({{0, 0, 0}}, {kBlack})).symmetric;
  EXPECT_NEAR(red.color_mse[0], 0.2126 * 0.2126, kFloatColor);
  EXPECT_NEAR(red.color_mse[1], 0.1146 * 0.1146, kFloatColor);
  EXPECT_NEAR(red.color_mse[2], 0.25, kFloatColor);
  const MpegDirection blue =
      distortion(test::cloud_of({{0, 0, 0}}, {{0, 0, 255}}), test::cloud_of({{0, 0, 0}}, {kBlack})).symmetric;
  EXPECT_NEAR(blue.color_mse[1], 0.25, kFloatColor);
  EXPECT_NEAR(blue.color_mse[2], 0.0458 * 0.0458, kFloatColor);
}

TEST(Mpeg, DuplicatesAreMergedIntoTheirTruncatedMeanColor) {
  // (0 + 255) / 2 is cut to 127; the merged cloud counts one point.
  const PointCloud twice = test::cloud_of({{1, 1, 1}, {1, 1, 1}}, {kBlack, kWhite});
  const MpegDistortion d = distortion(twice, test::cloud_of({{1, 1, 1}, {5, 1, 1}}, {kBlack, kBlack}));
  EXPECT_NEAR(d.reference_to_estimate.color_mse[0], sq_luma(127), 1e-8);
  EXPECT_EQ(d.estimate_to_reference.point_mse_m2, 8.0);  // 0 and 16, not weighted by the copies
  EXPECT_EQ(distortion(twice, twice).symmetric.color_mse[0], 0.0);
}

TEST(Mpeg, EquallyNearNeighborsGiveTheirRoundedMeanColor) {
  const PointCloud center = test::cloud_of({{0, 0, 0}}, {kBlack});
  const PointCloud around = test::cloud_of({{1, 0, 0}, {-1, 0, 0}, {0, 0, 5}}, {kWhite, kBlack, kWhite});
  // (255 + 0) / 2 is rounded to 128 here.
  EXPECT_NEAR(distortion(center, around).reference_to_estimate.color_mse[0], sq_luma(128), 1e-8);
}

TEST(Mpeg, NearlyEqualDistancesCountAsEqualStepByStep) {
  const float z = std::ldexp(1.0f, -14);  // z^2 = 3.7e-9
  const auto sq_luma_of_chain = [&](float third) {
    const PointCloud chain = test::cloud_of({{1, 0, 0}, {-1, 0, z}, {0, 1, third}, {0, -1, 0.5f}},
                                            {{30, 30, 30}, {60, 60, 60}, {90, 90, 90}, kWhite});
    return distortion(test::cloud_of({{0, 0, 0}}, {kBlack}), chain).reference_to_estimate.color_mse[0];
  };
  // 1, 3.7e-9 more, and 1.1e-8 more than that: too far.
  EXPECT_NEAR(sq_luma_of_chain(2.0f * z), sq_luma(45), 1e-8);
  // A step of 8.3e-9 is near enough, though it leads 1.2e-8 away from the nearest.
  EXPECT_NEAR(sq_luma_of_chain(1.8f * z), sq_luma(60), 1e-8);
}

TEST(Mpeg, ManyEquallyNearNeighborsAreLookedFor) {
  // Twelve at one distance, more than the ten first asked for: the mean is of all.
  std::vector<Eigen::Vector3f> icosahedral;
  std::vector<Rgb8> colors;
  for (int k = 0; k < 12; ++k) {
    const int axis = k / 4;
    Eigen::Vector3f p(0, 0, 0);
    p[axis] = k % 2 == 0 ? 1.0f : -1.0f;
    p[(axis + 1) % 3] = k % 4 < 2 ? 2.0f : -2.0f;
    icosahedral.push_back(p);
    const auto gray = static_cast<std::uint8_t>(20 * k);
    colors.push_back({gray, gray, gray});
  }
  const MpegDistortion d = distortion(test::cloud_of({{0, 0, 0}}, {kBlack}), test::cloud_of(icosahedral, colors));
  EXPECT_NEAR(d.reference_to_estimate.color_mse[0], sq_luma(110), 1e-8);
}

TEST(Mpeg, OfACloudAndItselfIsPerfect) {
  for (const PointCloud& cloud :
       {test::two_sheets(500, 10).reference, test::painted_triplicates(200), test::cloud_of({{1, 2, 3}}, {kWhite})}) {
    const MpegDistortion same = distortion(cloud, cloud);
    EXPECT_EQ(same.symmetric.point_mse_m2, 0.0);
    EXPECT_EQ(same.symmetric.sq_hausdorff_m2, 0.0);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(same.symmetric.color_mse[c], 0.0);
      EXPECT_EQ(same.symmetric.color_psnr_db[c], INFINITY);
    }
  }
}

TEST(Mpeg, EqualsTheDefinitionWithoutTies) {
  const test::Clouds clouds = test::two_sheets();
  const auto nearest = test::nearest_by_definition(clouds.reference, clouds.estimate);
  double mse = 0.0, sq_hausdorff = 0.0;
  Eigen::Vector3d color_mse = Eigen::Vector3d::Zero();
  const auto n = static_cast<double>(nearest.size());
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const double sq = nearest[i].distance_m * nearest[i].distance_m;
    mse += sq / n;
    sq_hausdorff = std::max(sq_hausdorff, sq);
    const Eigen::Vector3d difference =
        test::unit_color(clouds.reference, i) - test::unit_color(clouds.estimate, nearest[i].index);
    color_mse += rgb_to_ycbcr709(difference).cwiseAbs2() / n;
  }
  const MpegDirection found = distortion(clouds.reference, clouds.estimate).reference_to_estimate;
  // The tool subtracts positions in float: 1e-7 of a difference.
  EXPECT_NEAR_RELATIVE(found.point_mse_m2, mse, 1e-6);
  EXPECT_NEAR_RELATIVE(found.sq_hausdorff_m2, sq_hausdorff, 1e-6);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(found.color_mse[c], color_mse[static_cast<Eigen::Index>(c)], kFloatColor);
}

TEST(Mpeg, SymmetricIsTheWorseOfBothAndTheOrderOfPointsDoesNotMatter) {
  const test::Clouds clouds = test::two_sheets(600, 500);
  const MpegDistortion d = distortion(clouds.reference, clouds.estimate);
  const test::Clouds other = test::permuted(clouds);
  const MpegDistortion swapped = distortion(other.estimate, other.reference);
  EXPECT_EQ(d.symmetric.point_mse_m2,
            std::max(d.reference_to_estimate.point_mse_m2, d.estimate_to_reference.point_mse_m2));
  EXPECT_EQ(d.symmetric.color_psnr_db[0],
            std::min(d.reference_to_estimate.color_psnr_db[0], d.estimate_to_reference.color_psnr_db[0]));
  EXPECT_EQ(swapped.symmetric.point_mse_m2, d.symmetric.point_mse_m2);
  EXPECT_EQ(swapped.symmetric.color_mse, d.symmetric.color_mse);
  EXPECT_EQ(swapped.estimate_to_reference.sq_hausdorff_m2, d.reference_to_estimate.sq_hausdorff_m2);
}

TEST(Mpeg, RefusesCloudsWithoutPointsOrColors) {
  const MpegCloud good{{{0, 0, 0}}, {kBlack}};
  EXPECT_THROW(mpeg_distortion({}, good), std::invalid_argument);
  EXPECT_THROW(mpeg_distortion(good, {}), std::invalid_argument);
  EXPECT_THROW(mpeg_distortion(good, {{{0, 0, 0}}, {}}), std::invalid_argument);
}

}  // namespace mpeg_test
}  // namespace cmap
