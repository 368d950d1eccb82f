#include <nlohmann/json.hpp>

#include "align/align_testing.hpp"
#include "align/towns.hpp"
#include "cmap/align/align.hpp"
#include "cmap/align/global.hpp"
#include "cmap/align/icp.hpp"

namespace cmap {
namespace verdict_test {

/// A window of the town of the tests, other samples for every seed.
PointCloud window(double x, double y, double half_m, unsigned seed, std::size_t n = 200'000) {
  return crop(test::town(100, n, seed), {{x - half_m, y - half_m, -100}, {x + half_m, y + half_m, 100}});
}

Similarity about_z(double degrees, const Eigen::Vector3d& shift) {
  return {1.0, rotation_from(Eigen::Vector3d(0, 0, degrees * M_PI / 180.0)), shift};
}

/// Right, or not trusted.
void expect_right_or_honest(const PointCloud& source, const PointCloud& target, const Similarity& truth,
                            double tolerance_m) {
  try {
    const Alignment found = align(source, target, registration_method("global"));
    if (!is_trusted(found.judgment.verdict)) return;
    EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), truth, source), tolerance_m)
        << found.judgment.reason;
  } catch (const UnsupportedError&) {
    // Honest.
  }
}

/// A hall whose two ends are alike, with noise.
PointCloud hall(std::mt19937_64& random, double length_m, double width_m, std::size_t n, bool with_ends) {
  PointCloud cloud;
  for (std::size_t i = 0; i < n; ++i) {
    const double u = test::uniform(random), v = test::uniform(random);
    const double x = length_m * (u - 0.5), y = width_m * (u - 0.5), z = 4.0 * v, w = width_m * (v - 0.5);
    const double noise = 0.004 * (test::uniform(random) - 0.5);
    switch (random() % (with_ends ? 5 : 4)) {
      case 0:
        cloud.positions.push_back(Eigen::Vector3d(x, w, noise).cast<float>());
        break;
      case 1:
        cloud.positions.push_back(Eigen::Vector3d(x, w, 4.0 + noise).cast<float>());
        break;
      case 2:
        cloud.positions.push_back(Eigen::Vector3d(x, -0.5 * width_m + noise, z).cast<float>());
        break;
      case 3:
        cloud.positions.push_back(Eigen::Vector3d(x, 0.5 * width_m + noise, z).cast<float>());
        break;
      default: {
        const double end = random() % 2 == 0 ? -0.5 : 0.5;
        cloud.positions.push_back(Eigen::Vector3d(end * length_m + noise, y, z).cast<float>());
      }
    }
  }
  return cloud;
}

TEST(Verdict, HalfSharedIsDetermined) {
  const PointCloud target = window(-10, 0, 45, 1), source = window(25, 20, 45, 2);
  const Similarity A = about_z(100, {20, 40, 1});
  const Alignment found = align(transformed(source, A.matrix()), target, registration_method("global"));
  EXPECT_EQ(found.judgment.verdict, Verdict::kDetermined) << found.judgment.reason;
  EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), A.inverse(), transformed(source, A.matrix())), 0.2);
  EXPECT_GT(found.judgment.score, 0.6);
}

TEST(Verdict, TwoPlacesAreNotTrusted) {
  const PointCloud target = window(-55, -55, 40, 3), source = window(55, 55, 40, 4);
  expect_right_or_honest(source, target, about_z(0, {0, 0, 0}), 0.5);
}

TEST(Verdict, OneInsideTheOther) {
  const PointCloud target = window(0, 0, 40, 5), source = window(12, -8, 13, 6, 400'000);
  const Similarity A = about_z(-70, {300, 5, 2});
  expect_right_or_honest(transformed(source, A.matrix()), target, A.inverse(), 0.5);
}

TEST(Verdict, ASymmetricHallIsAmbiguous) {
  std::mt19937_64 random(7);
  const PointCloud target = hall(random, 30, 12, 60'000, true), source = hall(random, 30, 12, 60'000, true);
  const Alignment found = align(source, target, registration_method("gicp"));
  EXPECT_EQ(found.judgment.verdict, Verdict::kAmbiguous) << found.judgment.reason;
  ASSERT_FALSE(found.judgment.rivals.empty());
  const Similarity rival = similarity_from(found.judgment.rivals[0].T_dst_src);
  EXPECT_NEAR(rotation_angle_rad(rival.rotation) * 180.0 / M_PI, 180.0, 2.0);
}

TEST(Verdict, ACorridorIsNotTrusted) {
  std::mt19937_64 random(8);
  const PointCloud target = hall(random, 40, 3, 60'000, false), source = hall(random, 40, 3, 60'000, false);
  const Similarity moved = about_z(0, {6, 0, 0});
  expect_right_or_honest(transformed(source, moved.matrix()), target, moved.inverse(), 0.5);
}

/// x, y or z the other way round.
TEST(Verdict, AMirrorImageIsNamed) {
  const PointCloud target = window(0, 0, 45, 9), sample = window(0, 0, 45, 10);
  for (int axis = 0; axis < 3; ++axis) {
    PointCloud source = sample;
    for (Eigen::Vector3f& p : source.positions) p[axis] = -p[axis];
    for (const char* method : {"gicp", "global"}) {
      const Alignment found = align(source, target, registration_method(method));
      EXPECT_EQ(found.judgment.verdict, Verdict::kMirrored) << method << axis << ": " << found.judgment.reason;
    }
  }
}

TEST(Verdict, AWrongStartIsRightOrNotTrusted) {
  const PointCloud target = window(0, 0, 45, 11), source = window(5, 5, 45, 12);
  AlignOptions options;
  options.T_initial = about_z(90, {-20, 10, 0}).matrix();
  const Alignment found = align(source, target, registration_method("gicp"), options);
  const bool is_right = test::displacement_m(similarity_from(found.T_dst_src), {}, source) < 0.2;
  EXPECT_EQ(is_trusted(found.judgment.verdict), is_right) << found.judgment.reason;
}

TEST(Verdict, AHundredTimesDenserAndRepeatedPoints) {
  const PointCloud target = window(0, 0, 40, 13, 1'500'000);
  PointCloud sparse = window(8, 4, 40, 14, 15'000), repeated = window(8, 4, 40, 15, 60'000);
  const std::size_t n = repeated.size();
  for (std::size_t i = 0; i < 2 * n; ++i) repeated.positions.push_back(repeated.positions[i % n]);
  const Similarity A = about_z(180, {-30, 12, 1});
  for (const PointCloud& source : {sparse, repeated}) {
    expect_right_or_honest(transformed(source, A.matrix()), target, A.inverse(), 0.5);
  }
}

TEST(Verdict, TenPointsAndAPlane) {
  const PointCloud target = window(0, 0, 40, 16);
  PointCloud few = target, plane = test::uniform_cloud(20'000, 17);
  few.positions.resize(10);
  for (Eigen::Vector3f& p : plane.positions) p.z() = 0.0f;
  expect_right_or_honest(few, target, {}, 0.5);
  expect_right_or_honest(plane, plane, {}, 1e-3);
}

TEST(Verdict, YUpAndGeoreferenced) {
  const PointCloud target = window(0, 0, 40, 18), source = window(6, 3, 40, 19);
  const Similarity y_up{1.0, rotation_from(Eigen::Vector3d(-M_PI / 2.0, 0, 0)), {0, 0, 0}};
  const Similarity utm = about_z(25, {363'000, 5'621'000, 110});
  for (const Similarity& A : {y_up, utm}) {
    const PointCloud moved = transformed(source, A.matrix());
    const Alignment found = align(moved, target, registration_method("global"));
    EXPECT_TRUE(is_trusted(found.judgment.verdict)) << found.judgment.reason;
    EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), A.inverse(), moved), 0.2);
  }
}

TEST(Verdict, MovingObjectsDoNotDecide) {
  PointCloud target = window(0, 0, 40, 20), source = window(10, 0, 40, 21);
  std::mt19937_64 random(22);
  for (PointCloud* cloud : {&target, &source}) {
    for (int car = 0; car < 40; ++car) {
      const Eigen::Vector3d place = test::random_vector(random, 38).cwiseProduct(Eigen::Vector3d(1, 1, 0));
      for (int i = 0; i < 100; ++i) {
        const Eigen::Vector3d p = test::random_vector(random, 1).cwiseProduct(Eigen::Vector3d(2, 1, 0.7));
        cloud->positions.push_back((place + p + Eigen::Vector3d(0, 0, 1)).cast<float>());
      }
    }
  }
  const Similarity A = about_z(140, {5, -60, 0});
  expect_right_or_honest(transformed(source, A.matrix()), target, A.inverse(), 0.5);
}

TEST(Verdict, TheSameForAnyNumberOfThreads) {
  const PointCloud target = window(0, 0, 40, 25),
                   source = transformed(window(12, 6, 40, 26), about_z(50, {3, 4, 1}).matrix());
  const auto all_of = [&](const char* method, int threads) {
    AlignOptions options;
    options.T_initial = about_z(-50, {-5, 0, -1}).matrix();
    options.finest_m = 0.1;
    return alignment_json(align(source, target, registration_method(method), options, {.threads = threads})).dump();
  };
  for (const char* method : {"gicp", "global"}) EXPECT_EQ(all_of(method, 1), all_of(method, 3)) << method;
}

TEST(Verdict, RigidWhateverTheDigitsOfTheStart) {
  const PointCloud target = window(0, 0, 40, 23), source = window(0, 0, 40, 24);
  AlignOptions options;
  options.T_initial = about_z(3.3, {0.5, 0.2, 0.1}).matrix();
  for (double& v : options.T_initial.topLeftCorner<3, 4>().reshaped()) v = std::round(v * 1e6) / 1e6;
  const Eigen::Matrix3d R = align(source, target, registration_method("gicp"), options).T_dst_src.topLeftCorner<3, 3>();
  EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-9);
}

/// Errors of simulated pairs over what the standard errors say, in the direction that is the worst: 1 within a factor
/// of 1.5.
TEST(Verdict, StandardErrorsAreCalibrated) {
  IcpOptions options;
  options.levels = {{0.5, 2.0, 50}};
  double squares = 0.0;
  constexpr int kPairs = 12;
  for (unsigned pair = 0; pair < kPairs; ++pair) {
    PointCloud target = window(0, 0, 30, 100 + pair), source = window(20, 0, 30, 200 + pair);
    std::mt19937_64 random(300 + pair);
    for (PointCloud* cloud : {&target, &source}) {
      for (Eigen::Vector3f& p : cloud->positions) p += test::random_vector(random, 0.05).cast<float>();
    }
    const Alignment found = icp(source, target, Eigen::Matrix4d::Identity(), options);
    double sum_sq = 0.0;
    for (const WeakDirection& direction : found.standard_errors) sum_sq += std::pow(direction.standard_error_m, 2);
    const double error_m = test::displacement_m(similarity_from(found.T_dst_src), {}, source);
    squares += error_m * error_m / sum_sq / kPairs;
  }
  EXPECT_GT(std::sqrt(squares), 1.0 / 1.5);
  EXPECT_LT(std::sqrt(squares), 1.5);
}

}  // namespace verdict_test
}  // namespace cmap
