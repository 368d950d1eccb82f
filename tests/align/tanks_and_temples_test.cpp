#include "cmap/align/tanks_and_temples.hpp"

#include "align/align_testing.hpp"
#include "align/towns.hpp"

namespace cmap {
namespace tanks_and_temples_test {

using ::testing::HasSubstr;

TanksAndTemplesOptions options_for(double tau_m, bool refine = true) {
  TanksAndTemplesOptions options;
  options.tau_m = tau_m;
  options.refine = refine;
  return options;
}

PointCloud cloud_of(std::initializer_list<Eigen::Vector3f> positions) {
  PointCloud cloud;
  cloud.positions.assign(positions);
  return cloud;
}

TEST(TanksAndTemples, ScoresByHand) {
  // tau 1: source at x = 0.25 (0.25 away), 10.25 (1 away: not nearer), 20.25 (0.75 away); target also at 40.
  const PointCloud source = cloud_of({{0.25f, 0, 0}, {10.25f, 0, 0}, {20.25f, 0, 0}});
  const PointCloud target = cloud_of({{0, 0, 0}, {11.25f, 0, 0}, {21, 0, 0}, {40, 0, 0}});
  const auto found = tanks_and_temples(source, target, Eigen::Matrix4d::Identity(), options_for(1.0, false));
  EXPECT_DOUBLE_EQ(found.precision, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(found.recall, 2.0 / 4.0);
  EXPECT_DOUBLE_EQ(found.f_score, 4.0 / 7.0);
  EXPECT_DOUBLE_EQ(found.alignment.rmse_m, std::sqrt((0.0625 + 0.5625) / 2.0));
}

TEST(TanksAndTemples, ThinsToHalfTau) {
  // Two source points in one voxel of 0.5 m count once.
  const PointCloud source = cloud_of({{0.1f, 0, 0}, {0.2f, 0, 0}, {5, 0, 0}});
  const auto found =
      tanks_and_temples(source, cloud_of({{0, 0, 0}}), Eigen::Matrix4d::Identity(), options_for(1, false));
  EXPECT_EQ(found.n_source, 2u);
  EXPECT_DOUBLE_EQ(found.precision, 0.5);
  EXPECT_DOUBLE_EQ(found.recall, 1.0);
}

TEST(TanksAndTemples, NothingInCommonScoresZero) {
  const auto found = tanks_and_temples(cloud_of({{0, 0, 0}}), cloud_of({{100, 0, 0}}), Eigen::Matrix4d::Identity(),
                                       options_for(1.0, false));
  EXPECT_EQ(found.f_score, 0.0);
}

TEST(TanksAndTemples, CropsBoth) {
  TanksAndTemplesOptions options = options_for(1.0, false);
  options.crop = Box3d{{-1, -1, -1}, {1, 1, 1}};
  const PointCloud source = cloud_of({{0, 0, 0}, {50, 0, 0}}), target = cloud_of({{0, 0, 0}, {-70, 0, 0}});
  EXPECT_EQ(tanks_and_temples(source, target, Eigen::Matrix4d::Identity(), options).f_score, 1.0);
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] {
                tanks_and_temples(cloud_of({{9, 9, 9}}), target, Eigen::Matrix4d::Identity(), options);
              }),
              HasSubstr("no point of the source is inside the crop"));
}

TEST(TanksAndTemples, RefinesASimilarity) {
  const PointCloud target = test::town(40, 40000, 1);
  // Nearer than the toolbox's own first guess; from 1 % of the scale its first two stages, with both clouds on lattices
  // of one size, do not come closer.
  const Similarity T{1.001, rotation_from({0.001, -0.001, 0.003}), {0.1, -0.1, 0.05}};
  const PointCloud source = transformed(target, T.inverse().matrix());
  const auto found = tanks_and_temples(source, target, Eigen::Matrix4d::Identity(), options_for(0.5));
  // The last stage compares copies point by point; 30 iterations of it end far below a tenth of tau.
  EXPECT_LT(test::displacement_m(similarity_from(found.alignment.T_dst_src), T, source), 0.05);
  EXPECT_NEAR(found.alignment.scale, 1.001, 2e-4);
  EXPECT_GT(found.f_score, 0.99);
  EXPECT_LE(found.alignment.iterations, 90);
}

TEST(TanksAndTemples, RefusesWhatCannotBe) {
  const PointCloud cloud = test::town(20, 1000, 2);
  EXPECT_THROW(tanks_and_temples(cloud, cloud, Eigen::Matrix4d::Identity(), options_for(0.0)), UsageError);
  EXPECT_THROW(tanks_and_temples(cloud, cloud, Eigen::Matrix4d::Identity(), options_for(NAN)), UsageError);
  EXPECT_THROW(tanks_and_temples({}, cloud, Eigen::Matrix4d::Identity(), options_for(1.0)), UnsupportedError);
  PointCloud far = cloud;
  far.origin.x() += 1e4;
  EXPECT_THAT(test::refusal_of<UnsupportedError>(
                  [&] { tanks_and_temples(far, cloud, Eigen::Matrix4d::Identity(), options_for(0.5)); }),
              HasSubstr("no overlap"));
}

}  // namespace tanks_and_temples_test
}  // namespace cmap
