#include "cmap/align/global.hpp"

#include "align/align_testing.hpp"
#include "align/real_clouds.hpp"
#include "align/towns.hpp"
#include "cmap/align/align.hpp"
#include "cmap/core/execution.hpp"

namespace cmap {
namespace global_test {

using ::testing::HasSubstr;

/// How many random poses the tests on real data try: CMAP_TRIALS, or few.
int trials(int by_default) {
  const char* text = std::getenv("CMAP_TRIALS");
  return text ? std::atoi(text) : by_default;
}

TEST(Global, FindsAnyPoseOfATown) {
  const PointCloud target = test::town(45, 30000, 4), source = test::town(45, 30000, 5);
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 2; ++trial) {
    const Similarity A = test::random_similarity(random, 1.0, 1.0, 1000.0);
    const PointCloud moved = transformed(source, A.matrix());
    const Alignment found = global_registration(moved, target);
    EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), A.inverse(), moved), 0.2)
        << "other samples of the same town";
    EXPECT_EQ(found.method, "global");
    EXPECT_NEAR(found.scale, 1.0, 1e-12);
  }
}

TEST(Global, FindsPoseAndScaleWithPartialOverlap) {
  const PointCloud target = test::town(60, 60000, 7);
  PointCloud source = test::town(60, 60000, 8);
  source = crop(source, {{-60, -60, -50}, {25, 60, 50}});
  std::mt19937_64 random(9);
  const Similarity A = test::random_similarity(random, 1.2, 1.2, 100.0);
  GlobalOptions options;
  options.with_scale = true;
  const PointCloud moved = transformed(source, A.matrix());
  const Alignment found = global_registration(moved, target, options);
  EXPECT_NEAR(found.scale * 1.2, 1.0, 2e-3);
  EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), A.inverse(), moved), 0.3);
}

/// Millimeters, feet, and a network's unit.
TEST(Global, FindsScalesFromAThousandthToAThousand) {
  const PointCloud target = test::town(45, 30000, 4), source = test::town(45, 30000, 5);
  std::mt19937_64 random(16);
  AlignOptions options;
  options.with_scale = true;
  for (const double scale : {0.001001, 0.3048, 37.0, 999.0}) {
    Similarity A = test::random_similarity(random, 1.0 / scale, 1.0 / scale, 100.0);
    const PointCloud moved = transformed(source, A.matrix());
    const Alignment found = align(moved, target, registration_method("global"), options);
    EXPECT_EQ(found.judgment.verdict, Verdict::kDetermined) << scale << ": " << found.judgment.reason;
    EXPECT_NEAR(found.scale / scale, 1.0, 2e-3);
    EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), A.inverse(), moved), 0.3);
  }
}

TEST(Global, NamesTheScalesThatItSearched) {
  const PointCloud target = test::town(45, 30000, 4);
  AlignOptions options;
  options.with_scale = true;
  const auto scaled = [&](double scale) {
    return transformed(target, Similarity{scale, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()}.matrix());
  };
  EXPECT_THAT(
      test::refusal_of<UnsupportedError>([&] { align(scaled(1e-4), target, registration_method("global"), options); }),
      HasSubstr("scales from 0.001 to 1000 are searched"));
  // Nothing in common: a cloud of noise, of the town's size.
  PointCloud noise = test::uniform_cloud(20000, 17);
  const Eigen::Vector3d size = bounds(target).max - bounds(target).min;
  for (Eigen::Vector3f& p : noise.positions) p = p.cwiseProduct(size.cast<float>() / 2.0f);
  std::string reason;
  try {
    reason = align(noise, target, registration_method("global"), options).judgment.reason;
  } catch (const UnsupportedError& error) {
    reason = error.what();
  }
  EXPECT_THAT(reason, HasSubstr("were searched"));
}

/// One point in a hundred of the estimate is a stray, up to 150 m above a town of 36 m.
TEST(Global, StraysDoNotHideATown) {
  const PointCloud source = test::sample_town("estimate.ply"), target = test::sample_town("reference.ply");
  const Similarity A{1.0, rotation_from({0.0, 0.0, 2.0}), {30.0, -20.0, 5.0}};
  const PointCloud moved = transformed(source, A.matrix());
  const Alignment found = align(moved, target, registration_method("global"));
  EXPECT_EQ(found.judgment.verdict, Verdict::kDetermined) << found.judgment.reason;
  EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), A.inverse(), source), 0.5);  // its own drift
}

TEST(Global, TheSameForAnyNumberOfThreads) {
  const PointCloud target = test::town(40, 20000, 10), source = test::town(40, 20000, 11);
  const Alignment all = global_registration(source, target);
  const ExecutionScope one({.threads = 1});
  EXPECT_EQ(global_registration(source, target).T_dst_src, all.T_dst_src);
}

TEST(Global, RefusesWhatHasNoShape) {
  PointCloud few;
  few.positions.assign({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const PointCloud cloud = test::town(40, 5000, 12);
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { global_registration(few, cloud); }),
              HasSubstr("3 points of the source"));
  PointCloud plane = test::uniform_cloud(5000, 13);
  for (auto& p : plane.positions) p.z() = 0.0f;
  EXPECT_NE(test::refusal_of<UnsupportedError>([&] { global_registration(plane, plane); }), "");
  PointCloud point;
  point.positions.assign(100, Eigen::Vector3f(1, 2, 3));
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { global_registration(point, cloud); }), HasSubstr("coincide"));
}

/// The scans of two moments from random poses: to 2 cm and 0.2 degrees of the truth, 100 of 100 times.
TEST(Global, RealLidarPairFromRandomPoses) {
  SKIP_WITHOUT(test::LidarPair::folder());
  const test::LidarPair pair;
  const Similarity truth = similarity_from(pair.T_target_source);
  std::mt19937_64 random(14);
  const int n = trials(5);
  int recovered = 0;
  for (int trial = 0; trial < n; ++trial) {
    const Similarity A = test::random_similarity(random, 1.0, 1.0, 100.0);
    const Alignment found = align(transformed(pair.source, A.matrix()), pair.target, registration_method("global"));
    const Similarity T = similarity_from(found.T_dst_src) * A;
    recovered += (T.translation - truth.translation).norm() < 0.02 && test::angle_between_deg(T, truth) < 0.2;
  }
  EXPECT_EQ(recovered, n);
}

/// A copy of an aerial map, turned, moved and scaled: to 5 cm and 1e-3 of the scale, 100 of 100 times.
TEST(Global, RealAerialMapWithUnknownScale) {
  const auto path = test::data_folder() / "autzen/autzen_stadium_300m.ply";
  SKIP_WITHOUT(path);
  const PointCloud map = read_point_cloud(path).cloud;
  std::mt19937_64 random(15);
  AlignOptions options;
  options.with_scale = true;
  const int n = trials(2);
  int recovered = 0;
  for (int trial = 0; trial < n; ++trial) {
    const Similarity A = test::random_similarity(random, 0.7, 1.4, 500.0);
    const PointCloud moved = transformed(map, A.matrix());
    const Similarity T = similarity_from(align(moved, map, registration_method("global"), options).T_dst_src);
    recovered += test::displacement_m(T, A.inverse(), moved) < 0.05 && std::abs(T.scale * A.scale - 1.0) < 1e-3;
  }
  EXPECT_EQ(recovered, n);
}

}  // namespace global_test
}  // namespace cmap
