#include "cmap/align/global.hpp"

#include "align/align_testing.hpp"
#include "align/real_clouds.hpp"
#include "align/towns.hpp"
#include "cmap/align/align.hpp"
#include "cmap/core/execution.hpp"
#include "compatibility.hpp"
#include "features.hpp"

namespace cmap {
namespace global_test {

using ::testing::HasSubstr;

/// How many random poses the tests on real data try: CMAP_TRIALS, or few.
int trials(int by_default) {
  const char* text = std::getenv("CMAP_TRIALS");
  return text ? std::atoi(text) : by_default;
}

#define SKIP_WITHOUT_PCL() \
  if (unsupported_features()) GTEST_SKIP() << "cmap was built without PCL: no global registration"

bool unsupported_features() {
  const std::vector<Eigen::Vector3f> points(10, Eigen::Vector3f::Zero());
  return test::refusal_of<UnsupportedError>([&] { fpfh_features(points, points, 1.0); }) != "";
}

TEST(Features, FlippingTwiceGivesTheSame) {
  Fpfh feature;
  for (std::size_t i = 0; i < feature.size(); ++i) feature[i] = static_cast<float>(i);
  EXPECT_EQ(with_flipped_normals(with_flipped_normals(feature)), feature);
  EXPECT_EQ(with_flipped_normals(feature)[0], 10.0f);
  EXPECT_EQ(with_flipped_normals(feature)[11], 11.0f);
  EXPECT_EQ(with_flipped_normals(feature)[22], 32.0f);
}

/// The symmetry that with_flipped_normals() stands on, checked with PCL itself.
TEST(Features, FlippedNormalsMirrorTwoAngles) {
  SKIP_WITHOUT_PCL();
  std::mt19937_64 random(1);
  std::vector<Eigen::Vector3f> points, normals, flipped;
  for (int i = 0; i < 500; ++i) {
    points.push_back(test::uniform_point(random, 2.0f));
    normals.push_back(test::random_vector(random, 1.0).normalized().cast<float>());
    flipped.push_back(-normals.back());
  }
  const Array<Fpfh> plain = fpfh_features(points, normals, 0.5), turned = fpfh_features(points, flipped, 0.5);
  std::size_t n_equal = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const Fpfh mirrored = with_flipped_normals(turned[i]);
    double difference = 0.0;
    for (std::size_t k = 0; k < mirrored.size(); ++k) difference += std::abs(plain[i][k] - mirrored[k]);
    n_equal += difference < 10.0;  // of 300: angles on the border of a bin fall to its other side
  }
  EXPECT_GT(n_equal, plain.size() * 9 / 10);
}

TEST(Features, MutualMatchesByHand) {
  const auto feature = [](float v) {
    Fpfh f{};
    f[5] = v;
    return f;
  };
  const Array<Fpfh> source{feature(0), feature(10), feature(11)}, target{feature(12), feature(1), feature(100)};
  const std::vector<FeatureMatch> matches = mutual_matches(source, target);
  ASSERT_EQ(matches.size(), 2u) << "source 1 prefers target 0, which prefers source 2";
  EXPECT_EQ(matches[0].source, 0u);
  EXPECT_EQ(matches[0].target, 1u);
  EXPECT_EQ(matches[1].source, 2u);
  EXPECT_EQ(matches[1].target, 0u);
}

TEST(Compatibility, FindsTheTransformAmongWrongMatches) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 10; ++trial) {
    const Similarity T = test::random_similarity(random, 0.7, 1.4, 100.0);
    std::vector<Eigen::Vector3d> p, q;
    for (int i = 0; i < 600; ++i) {
      p.push_back(test::random_vector(random, 50.0));
      const bool right = i % 20 == 0;  // 5 %
      q.push_back(right ? T * p.back() + test::random_vector(random, 0.2) : test::random_vector(random, 60.0));
    }
    const auto found = compatible_hypotheses(p, q, T.scale, false, 1.0, 3);
    ASSERT_FALSE(found.empty());
    EXPECT_GE(found[0].n_inliers, 30u);
    // 30 matches of 0.2 m over 50 m.
    EXPECT_LT(test::angle_between_deg(found[0].T, T), 0.5);
  }
}

TEST(Compatibility, ScalesByVote) {
  std::mt19937_64 random(3);
  const Similarity T = test::random_similarity(random, 1.3, 1.3, 10.0);
  std::vector<Eigen::Vector3d> p, q;
  for (int i = 0; i < 500; ++i) {
    p.push_back(test::random_vector(random, 50.0));
    q.push_back(i % 4 == 0 ? T * p.back() : test::random_vector(random, 20.0));
  }
  bool among = false;
  for (const double scale : voted_scales(p, q, 5.0, 3)) among |= std::abs(scale / 1.3 - 1.0) < 0.02;
  EXPECT_TRUE(among);
  EXPECT_TRUE(voted_scales({}, {}, 1.0, 3).empty());
  EXPECT_TRUE(compatible_hypotheses({}, {}, 1.0, false, 1.0, 3).empty());
}

TEST(Global, FindsAnyPoseOfATown) {
  SKIP_WITHOUT_PCL();
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
  SKIP_WITHOUT_PCL();
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

TEST(Global, TheSameForAnyNumberOfThreads) {
  SKIP_WITHOUT_PCL();
  const PointCloud target = test::town(40, 20000, 10), source = test::town(40, 20000, 11);
  const Alignment all = global_registration(source, target);
  const ExecutionScope one({.threads = 1});
  EXPECT_EQ(global_registration(source, target).T_dst_src, all.T_dst_src);
}

TEST(Global, RefusesWhatHasNoShape) {
  SKIP_WITHOUT_PCL();
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

/// The scans of two moments from random poses: to 2 cm and 0.2 degrees of the truth, 98 of 100 times.
TEST(Global, RealLidarPairFromRandomPoses) {
  SKIP_WITHOUT_PCL();
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
  EXPECT_GE(recovered, n * 98 / 100) << "of " << n;
}

/// A copy of an aerial map, turned, moved and scaled: to 5 cm and 1e-3 of the scale, 98 of 100 times.
TEST(Global, RealAerialMapWithUnknownScale) {
  SKIP_WITHOUT_PCL();
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
  EXPECT_GE(recovered, n * 98 / 100) << "of " << n;
}

}  // namespace global_test
}  // namespace cmap
