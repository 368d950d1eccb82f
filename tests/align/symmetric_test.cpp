#include "align/align_testing.hpp"
#include "align/towns.hpp"
#include "cmap/align/align.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {
namespace symmetric_test {

using ::testing::HasSubstr;

Alignment run(const char* method, const PointCloud& source, const PointCloud& target, double voxel_m,
              const AlignOptions& options = {}) {
  return registration_method(method).run(source, target, options, voxel_m);
}

Alignment symmetric(const PointCloud& source, const PointCloud& target, double voxel_m,
                    const AlignOptions& options = {}) {
  return run("symmetric", source, target, voxel_m, options);
}

/// Walls across x, y and z, 2.8 m apart, their points at least 0.8 m from each other.
PointCloud loose_walls() {
  std::mt19937_64 random(1);
  PointCloud cloud;
  for (int i = 0; i < 3 * 36; ++i) {
    Eigen::Vector3d p = test::random_vector(random, 0.1) + Eigen::Vector3d(2.0, 2.0, 2.0);
    const Eigen::Index across = i % 3;
    p[across] = 0.0;
    p[(across + 1) % 3] += i / 3 % 6;
    p[(across + 2) % 3] += i / 18;
    cloud.positions.push_back(p.cast<float>());
  }
  return cloud;
}

/// With q = R p about the axis a by an angle t, q - p = 2 tan(t / 2) a x (p + q) / 2: linear in what the step solves
/// for, so that the first step is exact wherever the normals point, a second one on the first level and one on each of
/// the other two find nothing to do. Point to plane has (1 - cos t) of each radius left.
TEST(Symmetric, OneStepFindsATurn) {
  const PointCloud target = loose_walls();
  const Eigen::Vector3d center(3.5, 3.5, 0);
  Similarity T{1.0, rotation_from({0, 0, 0.07}), center};
  T.translation -= T.rotation * center;
  const PointCloud source = transformed(target, T.inverse().matrix());
  AlignOptions options;
  options.max_distance_m = 1.0;
  constexpr double kVoxel = 1e-3;  // joins no points
  // Points move by 0.07 rad times at most 5.2 m, less than half of what is between them: every match is right.
  const Alignment found = symmetric(source, target, kVoxel, options);
  EXPECT_EQ(found.iterations, 2 + 1 + 1);
  EXPECT_TRUE(found.converged);
  // Coordinates of 7 m are rounded to 2^-22 m twice.
  EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), T, source), 1e-6);
  EXPECT_GT(run("plane", source, target, kVoxel, options).iterations, found.iterations);
}

TEST(Symmetric, FindsTheMotionAndScaleOfACopy) {
  const PointCloud target = test::town(40, 30000, 2);
  Similarity T{1.0, rotation_from({0.01, -0.02, 0.05}), {0.5, -0.8, 0.3}};
  AlignOptions options;
  for (const double scale : {1.0, 1.01}) {
    T.scale = scale;
    options.with_scale = scale != 1.0;
    const PointCloud source = transformed(target, T.inverse().matrix());
    const Alignment found = symmetric(source, target, 0.5, options);
    // Thinned on another lattice: means of a voxel's few points lie anywhere in it, thousands of them.
    EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), T, source), 0.1 * 0.5);
    EXPECT_TRUE(found.converged);
    EXPECT_EQ(found.method, "symmetric");
  }
}

TEST(Symmetric, SurfacesThatSlideAreRefused) {
  PointCloud plane = test::uniform_cloud(3000, 3);
  for (auto& p : plane.positions) p.z() = 1.0f;
  PointCloud sphere = test::uniform_cloud(20000, 4, 2.0f);
  for (auto& p : sphere.positions) p = 5.0f * (p - Eigen::Vector3f::Ones()).normalized();
  PointCloud line = test::uniform_cloud(500, 5);
  for (auto& p : line.positions) p = Eigen::Vector3f(p.x(), 0, 0);
  const auto refusal = [](const PointCloud& cloud) {
    return test::refusal_of<UnsupportedError>([&] { symmetric(cloud, cloud, 0.05); });
  };
  EXPECT_THAT(refusal(plane), HasSubstr("translation along ("));
  EXPECT_THAT(refusal(plane), HasSubstr(", 0.00) is free"));
  EXPECT_THAT(refusal(sphere), HasSubstr("rotation about"));
  EXPECT_THAT(refusal(line), HasSubstr("no surface"));
}

TEST(Symmetric, TheSameForAnyNumberOfThreads) {
  const PointCloud target = test::town(40, 30000, 6), source = test::town(40, 30000, 7);
  const Alignment all = symmetric(source, target, 0.5);
  const ExecutionScope one({.threads = 1});
  const Alignment single = symmetric(source, target, 0.5);
  EXPECT_EQ(all.T_dst_src, single.T_dst_src);
  EXPECT_EQ(all.iterations, single.iterations);
  EXPECT_EQ(all.condition, single.condition);
}

/// An egg with dents: curved everywhere, no direction free.
PointCloud egg(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  PointCloud cloud;
  while (cloud.size() < n) {
    const Eigen::Vector3d inside = test::random_vector(random, 1.0);
    if (inside.norm() > 1.0) continue;
    const Eigen::Vector3d d = inside.normalized();
    const double r = 5.0 + 0.7 * std::sin(3.0 * d.x() + 1.0) * std::cos(4.0 * d.y()) + 0.5 * std::sin(5.0 * d.z());
    cloud.positions.push_back((r * d.cwiseProduct(Eigen::Vector3d(1.0, 1.3, 0.8))).cast<float>());
  }
  return cloud;
}

/// What the paper is about: planes leave a curved surface, circles do not. Of many pairs the median, as on some, by any
/// method, a few matches go to and fro until the iterations end.
TEST(Symmetric, TakesFewerStepsThanPlanesOnCurvedSurfaces) {
  Array<double> steps, steps_of_planes;
  for (unsigned seed = 0; seed < 9; ++seed) {
    const PointCloud target = egg(10000, 2 * seed), source = egg(10000, 2 * seed + 1);
    std::mt19937_64 random(seed);
    AlignOptions options;
    options.T_initial = Similarity{1.0, rotation_from(0.8 * test::random_vector(random, 1.0).normalized()),
                                   test::random_vector(random, 0.8)}
                            .matrix();
    const Alignment found = symmetric(source, target, 0.2, options);
    // The points lie on one surface: all that is left are normals of neighbors 0.2 m apart.
    EXPECT_LT(test::displacement_m(similarity_from(found.T_dst_src), {}, source), 0.01);
    steps.push_back(found.iterations);
    steps_of_planes.push_back(run("plane", source, target, 0.2, options).iterations);
  }
  EXPECT_LT(upper_median(steps), upper_median(steps_of_planes));
}

/// Starts far enough that some fail: 34 degrees and 4.8 m in a town of 35 m.
TEST(Symmetric, ConvergesInATownWherePlanesDo) {
  const PointCloud source = test::sample_town("estimate.ply"), target = test::sample_town("reference.ply");
  constexpr double kThere = 0.5;  // m; the estimate's own drift is some centimeters
  int of_planes = 0;
  for (unsigned seed = 100; seed < 116; ++seed) {
    std::mt19937_64 random(seed);
    const Eigen::Vector3d axis = test::random_vector(random, 1.0).normalized();
    AlignOptions options;
    options.T_initial =
        Similarity{1.0, rotation_from(0.6 * axis), 4.8 * test::random_vector(random, 1.0).normalized()}.matrix();
    const auto is_there = [&](const char* method) {
      try {
        const Alignment found = run(method, source, target, 0.5, options);
        return test::displacement_m(similarity_from(found.T_dst_src), {}, source) < kThere;
      } catch (const UnsupportedError&) {
        return false;
      }
    };
    if (!is_there("plane")) continue;
    ++of_planes;
    EXPECT_TRUE(is_there("symmetric")) << "start " << seed;
  }
  EXPECT_GE(of_planes, 8);
}

}  // namespace symmetric_test
}  // namespace cmap
