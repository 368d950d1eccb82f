#include "cmap/align/icp.hpp"

#include "align/align_testing.hpp"
#include "align/real_clouds.hpp"
#include "cmap/core/execution.hpp"

namespace cmap {
namespace icp_test {

using ::testing::HasSubstr;

constexpr std::array kMetrics{IcpMetric::kPoint, IcpMetric::kPlane, IcpMetric::kGicp};

/// The inside of a 6 x 5 x 3 m room with a box on the floor: every direction is determined.
PointCloud room(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  const Eigen::Vector3d size(6, 5, 3);
  PointCloud cloud;
  while (cloud.size() < n) {
    const bool in_box = random() % 4 == 0;
    const Eigen::Vector3d side = in_box ? Eigen::Vector3d(1.0, 0.7, 1.2) : size;
    Eigen::Vector3d p(test::uniform_in(random, 0, side.x()), test::uniform_in(random, 0, side.y()),
                      test::uniform_in(random, 0, side.z()));
    const auto axis = static_cast<Eigen::Index>(random() % 3);
    p[axis] = random() % 2 ? side[axis] : 0.0;
    if (in_box) p += Eigen::Vector3d(1.5, 3.0, 0.0);
    cloud.positions.push_back(p.cast<float>());
  }
  return cloud;
}

Similarity small_motion(unsigned seed, double angle_rad = 0.05, double shift_m = 0.1) {
  std::mt19937_64 random(seed);
  return {1.0, rotation_from(angle_rad * test::random_vector(random, 1.0).normalized()),
          shift_m * test::random_vector(random, 1.0).normalized()};
}

IcpOptions options_for(IcpMetric metric, double max_distance_m = 0.5) {
  IcpOptions options;
  options.metric = metric;
  options.levels = {{0.0, 2.0 * max_distance_m, 100}, {0.0, max_distance_m, 200}};
  options.min_rotation_rad = 1e-7;
  options.min_translation_voxels = 1e-6;
  return options;
}

const char* name(IcpMetric metric) {
  return metric == IcpMetric::kPoint ? "icp" : metric == IcpMetric::kPlane ? "plane" : "gicp";
}

class Icp : public ::testing::TestWithParam<IcpMetric> {};
INSTANTIATE_TEST_SUITE_P(Metrics, Icp, ::testing::ValuesIn(kMetrics), [](const auto& i) { return name(i.param); });

TEST_P(Icp, FindsTheMotionOfACopy) {
  const PointCloud target = room(20000, 1);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Similarity T = small_motion(seed);
    const PointCloud source = transformed(target, T.inverse().matrix());
    const Alignment found = icp(source, target, Eigen::Matrix4d::Identity(), options_for(GetParam()));
    // Copies meet exactly; coordinates of 6 m are rounded to 2^-22 m twice.
    EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), T, source), 2e-6);
    EXPECT_LT(found.rmse_m, 2e-6);
    EXPECT_EQ(found.overlap, 1.0);
    EXPECT_EQ(found.n_matches, source.size());
    EXPECT_EQ(found.scale, 1.0);
    EXPECT_TRUE(found.converged);
    EXPECT_GT(found.condition, 1e-3);
    EXPECT_EQ(found.method, name(GetParam()));
  }
}

TEST_P(Icp, SwappingExactCopiesGivesTheInverse) {
  const PointCloud target = room(10000, 2);
  const PointCloud source = transformed(target, small_motion(3).inverse().matrix());
  const Alignment there = icp(source, target, Eigen::Matrix4d::Identity(), options_for(GetParam()));
  const Alignment back = icp(target, source, Eigen::Matrix4d::Identity(), options_for(GetParam()));
  EXPECT_TRUE((there.T_dst_src * back.T_dst_src).isApprox(Eigen::Matrix4d::Identity(), 1e-5));
}

TEST_P(Icp, MovingBothCloudsMovesTheResult) {
  const PointCloud target = room(5000, 4), source = room(5000, 5);
  const Similarity initial = small_motion(6, 0.02, 0.05);
  const Similarity found = similarity_from(icp(source, target, initial.matrix(), options_for(GetParam())).T_dst_src);
  std::mt19937_64 random(7);
  const Similarity A = test::random_similarity(random, 1.0, 1.0, 50.0);
  const Similarity B = test::random_similarity(random, 1.0, 1.0, 50.0);
  const PointCloud moved_source = transformed(source, A.matrix());
  const Similarity start = B * initial * A.inverse();
  const Similarity expected = B * found * A.inverse();
  const Alignment again = icp(moved_source, transformed(target, B.matrix()), start.matrix(), options_for(GetParam()));
  // Other samples of the same room: rounding to float may change single matches among 5000, each up to 0.1 m.
  EXPECT_LT(test::displacement_m(similarity_from(again.T_dst_src), expected, moved_source), 1e-4);
}

TEST_P(Icp, TheOrderOfPointsDoesNotMatter) {
  const PointCloud target = room(5000, 8);
  PointCloud source = room(5000, 9);
  const Alignment found = icp(source, target, small_motion(10).matrix(), options_for(GetParam()));
  std::mt19937_64 random(11);
  std::shuffle(source.positions.begin(), source.positions.end(), random);
  const Alignment again = icp(source, target, small_motion(10).matrix(), options_for(GetParam()));
  EXPECT_TRUE(found.T_dst_src.isApprox(again.T_dst_src, 1e-9));
}

TEST_P(Icp, TheSameForAnyNumberOfThreads) {
  const PointCloud target = room(20000, 12), source = room(20000, 13);
  const Alignment all = icp(source, target, small_motion(14).matrix(), options_for(GetParam()));
  const ExecutionScope one({.threads = 1});
  const Alignment single = icp(source, target, small_motion(14).matrix(), options_for(GetParam()));
  EXPECT_EQ(all.T_dst_src, single.T_dst_src);
  EXPECT_EQ(all.rmse_m, single.rmse_m);
  EXPECT_EQ(all.condition, single.condition);
}

TEST_P(Icp, WorksAtUtmCoordinates) {
  PointCloud target = room(10000, 15);
  const Similarity T = small_motion(16);
  PointCloud source = transformed(target, T.inverse().matrix());
  const Eigen::Vector3d utm(5e5, 4e6, 100);
  target.origin += utm;
  source.origin += utm;
  const Alignment found = icp(source, target, Eigen::Matrix4d::Identity(), options_for(GetParam()));
  const Eigen::Matrix3d R = found.T_dst_src.topLeftCorner<3, 3>();
  const Eigen::Vector3d t = found.T_dst_src.topRightCorner<3, 1>() + R * utm - utm;
  EXPECT_LT((t - T.translation).norm(), 3e-6);
  EXPECT_LT(rotation_angle_rad(R.transpose() * T.rotation), 1e-6);
}

TEST_P(Icp, KeepsTheScaleOfTheStart) {
  const PointCloud target = room(10000, 17);
  Similarity T = small_motion(18);
  T.scale = 0.5;
  const PointCloud source = transformed(target, T.inverse().matrix());
  const Similarity start{0.5, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  const Alignment found = icp(source, target, start.matrix(), options_for(GetParam()));
  EXPECT_NEAR(found.scale, 0.5, 1e-12);
  EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), T, source), 2e-6);
}

TEST_P(Icp, FindsTheScaleWhereAsked) {
  const PointCloud target = room(10000, 19);
  Similarity T = small_motion(20, 0.01, 0.02);
  T.scale = 1.01;
  IcpOptions options = options_for(GetParam());
  options.with_scale = true;
  options.min_scale = 1e-8;
  const Alignment found = icp(transformed(target, T.inverse().matrix()), target, Eigen::Matrix4d::Identity(), options);
  EXPECT_NEAR(found.scale, 1.01, 1e-6);
}

TEST_P(Icp, OutliersCountLittle) {
  const PointCloud target = room(10000, 21);
  const Similarity T = small_motion(22, 0.02, 0.05);
  PointCloud source = transformed(target, T.inverse().matrix());
  std::mt19937_64 random(23);
  for (std::size_t i = 0; i < source.size(); i += 5) source.positions[i] += Eigen::Vector3f(0.1f, 0.05f, 0.1f);
  IcpOptions options = options_for(GetParam());
  options.kernel_width = 0.01;
  const Alignment robust = icp(source, target, Eigen::Matrix4d::Identity(), options);
  options.kernel = RobustKernel::kNone;
  const Alignment plain = icp(source, target, Eigen::Matrix4d::Identity(), options);
  const double robust_error = test::displacement_m(similarity_from(robust.T_dst_src), T, source);
  EXPECT_LT(robust_error, 0.01);
  EXPECT_LT(robust_error, 0.5 * test::displacement_m(similarity_from(plain.T_dst_src), T, source));
}

TEST_P(Icp, SurfacesThatSlideAreRefused) {
  PointCloud plane = test::uniform_cloud(3000, 24);
  for (auto& p : plane.positions) p.z() = 1.0f;
  const auto align = [&](const PointCloud& cloud) {
    return test::refusal_of<UnsupportedError>(
        [&] { icp(cloud, cloud, Eigen::Matrix4d::Identity(), options_for(GetParam())); });
  };
  EXPECT_THAT(align(plane), HasSubstr("translation along ("));
  EXPECT_THAT(align(plane), HasSubstr(", 0.00) is free"));
  std::mt19937_64 random(24);
  for (auto& p : plane.positions) p.z() = static_cast<float>(test::uniform_in(random, -0.02, 0.02));
  EXPECT_THAT(align(plane), HasSubstr("translation along (")) << "noise does not hold a plane in place";

  PointCloud sphere = test::uniform_cloud(20000, 25, 2.0f);
  for (auto& p : sphere.positions) p = 5.0f * (p - Eigen::Vector3f::Ones()).normalized();
  EXPECT_THAT(align(sphere), HasSubstr("rotation about"));

  PointCloud corridor = test::uniform_cloud(3000, 26);
  for (std::size_t i = 0; i < corridor.size(); ++i) corridor.positions[i][1 + static_cast<int>(i % 2)] = 0.0f;
  EXPECT_THAT(align(corridor), HasSubstr("translation along (1.00, 0.00, 0.00) is free"));
}

TEST_P(Icp, LinesAndSinglePointsAreRefused) {
  PointCloud line = test::uniform_cloud(500, 27);
  for (auto& p : line.positions) p = Eigen::Vector3f(p.x(), 0, 0);
  PointCloud point;
  point.positions.assign(100, Eigen::Vector3f(1, 2, 3));
  PointCloud two;
  two.positions.assign({{0, 0, 0}, {1, 0, 0}});
  for (const PointCloud& cloud : {line, point, two}) {
    EXPECT_NE(test::refusal_of<UnsupportedError>(
                  [&] { icp(cloud, cloud, Eigen::Matrix4d::Identity(), options_for(GetParam())); }),
              "");
  }
}

TEST_P(Icp, CloudsThatDoNotMeetAreRefused) {
  PointCloud source = room(1000, 28);
  source.origin.x() += 100.0;
  EXPECT_THAT(test::refusal_of<UnsupportedError>(
                  [&] { icp(source, room(1000, 29), Eigen::Matrix4d::Identity(), options_for(GetParam())); }),
              HasSubstr("no overlap: 0 points"));
}

/// From the identity, half a meter and 0.7 degrees away.
TEST_P(Icp, RealLidarPair) {
  SKIP_WITHOUT(test::LidarPair::folder());
  const test::LidarPair pair;
  IcpOptions options;
  options.metric = GetParam();
  options.levels = coarse_to_fine(0.2, 2.0);
  const Alignment found = icp(pair.source, pair.target, Eigen::Matrix4d::Identity(), options);
  const Similarity T = similarity_from(found.T_dst_src), truth = similarity_from(pair.T_target_source);
  EXPECT_LT((T.translation - truth.translation).norm(), 0.02);
  EXPECT_LT(test::angle_between_deg(T, truth), 0.2);
  EXPECT_TRUE(found.converged);
}

TEST(IcpOptionsTest, SayWhatIsWrong) {
  const PointCloud cloud = room(100, 30);
  const auto refusal = [&](auto&& change) {
    IcpOptions options;
    change(options);
    try {
      icp(cloud, cloud, Eigen::Matrix4d::Identity(), options);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal([](auto& o) { o.levels.clear(); }), HasSubstr("levels is empty"));
  EXPECT_THAT(refusal([](auto& o) { o.levels[0].voxel_m = -1; }), HasSubstr("voxel_m is -1"));
  EXPECT_THAT(refusal([](auto& o) { o.levels[0].max_distance_m = NAN; }), HasSubstr("max_distance_m is nan"));
  EXPECT_THAT(refusal([](auto& o) { o.levels[0].max_iterations = 0; }), HasSubstr("max_iterations is 0"));
  EXPECT_THAT(refusal([](auto& o) { o.neighbors = 3; }), HasSubstr("neighbors is 3"));
  EXPECT_THAT(refusal([](auto& o) { o.kernel_width = 0; }), HasSubstr("kernel_width is 0"));
  EXPECT_THROW(icp({}, cloud, Eigen::Matrix4d::Identity(), {}), std::invalid_argument);
}

TEST(RobustKernelTest, ByHand) {
  EXPECT_EQ(robust_weight(RobustKernel::kNone, 7.0, 1.0), 1.0);
  EXPECT_EQ(robust_weight(RobustKernel::kHuber, 0.5, 1.0), 1.0);
  EXPECT_EQ(robust_weight(RobustKernel::kHuber, 4.0, 1.0), 0.25);
  EXPECT_EQ(robust_weight(RobustKernel::kCauchy, 3.0, 1.0), 0.1);
}

}  // namespace icp_test
}  // namespace cmap
