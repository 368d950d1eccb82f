#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cmap/align/icp.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/geometry/rotation.hpp"
#include "cmap/lio/loop_closure.hpp"
#include "cmap/spatial/k_nearest.hpp"
#include "lio/balm_hall.hpp"
#include "lio/wall_thickness.hpp"
#include "loops/plane_grid.hpp"
#include "loops/submaps.hpp"

// Loops of a real hall that was walked through by hand. Its trusses repeat every 6.5 m, and it looks nearly the same
// turned by 180 degrees: what looks alike is as often wrong as right there, and the drift bound decides.

namespace cmap {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

/// The hall with its loops closed, once for all tests.
struct Hall {
  std::vector<Keyframe> keyframes = test::balm_hall_keyframes();
  std::vector<test::MeasuredLoop> measured = test::balm_hall_loops();
  LoopOptions options = loop_options_for(keyframes);
  LoopClosure closure = close_loops(keyframes, options);
  std::vector<double> paths_m = path_lengths_m(keyframes);

  Poses before() const {
    Poses poses;
    for (const Keyframe& keyframe : keyframes) poses.push_back(keyframe.T_world_body);
    return poses;
  }

  static const Hall& get() {
    static const Hall hall;
    return hall;
  }
};

class BalmHall : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(test::balm_hall_folder())) {
      GTEST_SKIP() << "no real data: " << test::balm_hall_folder() << " is missing; set CMAP_DATA_DIR";
    }
  }
};

/// Keyframes about one, at some poses, in the axes of the one in the middle.
PointCloud gathered(const Hall& hall, const Poses& poses, std::size_t center, std::size_t reach) {
  PointCloud cloud;
  const std::size_t first = center - std::min(center, reach);
  for (std::size_t k = first; k <= center + reach && k < poses.size(); ++k) {
    const Eigen::Isometry3f T = (poses[center].inverse() * poses[k]).cast<float>();
    for (const Eigen::Vector3f& p : hall.keyframes[k].points_body) cloud.positions.push_back(T * p);
  }
  return cloud;
}

/// Median distance of a cloud's points from planes through the ten nearest points of another.
double plane_residual_m(const PointCloud& source, const PointCloud& target, const Eigen::Isometry3d& T_target_source) {
  constexpr std::size_t kNeighbors = 10;
  const Bvh index(sort_points(target));
  const PointBlocks queries = sort_points(transformed(source, T_target_source.matrix()));
  const Array<std::uint32_t> nearest = find_k_nearest(index, queries, kNeighbors);
  std::vector<double> residuals;
  for (std::size_t slot = 0; slot < queries.size; ++slot) {
    const Eigen::Vector3d p = queries.world(slot);
    std::vector<Eigen::Vector3d> around;
    for (std::size_t k = 0; k < kNeighbors; ++k) {
      const std::uint32_t neighbor = nearest[slot * kNeighbors + k];
      around.push_back(index.points.world(neighbor));
    }
    const auto plane = plane_of(around, 1.0);
    if (!plane || (around.front() - p).norm() > 0.5 || plane->thickness_m > 0.1) continue;
    residuals.push_back(std::abs(plane->normal.dot(p - plane->mean)));
  }
  return residuals.empty() ? std::nan("") : median(residuals);
}

/// ICP between the keyframes about i and j, from the published poses; other settings and metric than the loops'.
Eigen::Isometry3d icp_between(const Hall& hall, std::size_t i, std::size_t j, std::size_t reach) {
  const Poses poses = hall.before();
  IcpOptions options;
  options.levels = {{0.4, 1.0, 50}, {0.2, 0.5, 50}};
  const Eigen::Isometry3d start = poses[i].inverse() * poses[j];
  return Eigen::Isometry3d(
      icp(gathered(hall, poses, j, reach), gathered(hall, poses, i, reach), start.matrix(), options).T_dst_src);
}

const LoopCandidate* found_near(const Hall& hall, const test::MeasuredLoop& loop) {
  constexpr double kNear_m = 1.5;  // of path
  const auto near = [&](std::size_t a, std::size_t b) {
    return std::abs(hall.paths_m[a] - hall.paths_m[b]) <= kNear_m;
  };
  for (const LoopCandidate& c : hall.closure.candidates) {
    if (c.accepted && near(c.from, loop.i) && near(c.to, loop.j)) return &c;
  }
  return nullptr;
}

TEST_F(BalmHall, FindsAtLeastFiveOfTheSevenMeasuredPlaces) {
  const Hall& hall = Hall::get();
  int n_found = 0;
  for (const test::MeasuredLoop& loop : hall.measured) {
    const LoopCandidate* const found = found_near(hall, loop);
    if (found == nullptr) continue;
    ++n_found;
    EXPECT_NEAR(found->correction_m, loop.correction_m, 0.05) << loop.i << "-" << loop.j;
  }
  EXPECT_GE(n_found, 5);
  RecordProperty("found", n_found);
}

TEST_F(BalmHall, NoAcceptedLoopIsFarFromIcpBetweenThePublishedPoses) {
  const Hall& hall = Hall::get();
  ASSERT_GT(hall.closure.n_loops, 10U);
  double worst_m = 0.0;
  for (const LoopCandidate& c : hall.closure.candidates) {
    if (!c.accepted) continue;
    const Eigen::Isometry3d expected = icp_between(hall, c.from, c.to, 3);
    const double off_m = (expected.translation() - c.T_from_to.translation()).norm();
    worst_m = std::max(worst_m, off_m);
    EXPECT_LT(off_m, 0.3) << c.from << "-" << c.to;
  }
  std::cout << fmt::format("accepted loops: {}, farthest from ICP {:.3f} m\n", hall.closure.n_loops, worst_m);
}

TEST_F(BalmHall, ClosedPosesFitTheMeasuredPairsLikeIcp) {
  const Hall& hall = Hall::get();
  for (const test::MeasuredLoop& loop : hall.measured) {
    if (found_near(hall, loop) == nullptr) continue;
    const PointCloud source = gathered(hall, hall.before(), loop.j, 0),
                     target = gathered(hall, hall.before(), loop.i, 0);
    const auto residual_m = [&](const Eigen::Isometry3d& T) { return plane_residual_m(source, target, T); };
    const Poses before = hall.before();
    const Poses& after = hall.closure.poses;
    const double by_icp_m = residual_m(icp_between(hall, loop.i, loop.j, 0));
    const double before_m = residual_m(before[loop.i].inverse() * before[loop.j]);
    const double after_m = residual_m(after[loop.i].inverse() * after[loop.j]);
    std::cout << fmt::format("{}-{}: residual {:.4f} m before, {:.4f} after, {:.4f} by ICP, {:.3f} measured\n", loop.i,
                             loop.j, before_m, after_m, by_icp_m, loop.residual_m);
    EXPECT_LT(after_m, 1.5 * loop.residual_m) << loop.i << "-" << loop.j;
    EXPECT_LT(after_m, 1.5 * by_icp_m) << loop.i << "-" << loop.j;
    EXPECT_LT(after_m, before_m) << loop.i << "-" << loop.j;
  }
}

/// Thicknesses of walls about ends of loops, as one pass sees them, and as both do.
struct Thicknesses {
  std::vector<double> single_m, both_m;
};
void add_thickness_at(const Hall& hall, const Poses& poses, std::size_t here, std::size_t there, Thicknesses& sums) {
  constexpr std::size_t kReach = 3;
  PointCloud cloud = gathered(hall, poses, here, kReach);
  const PlaneGrid walls(cloud, 0.5);
  const auto append = [](std::vector<double>& all, const std::vector<double>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  append(sums.single_m, test::wall_thickness_m(cloud, walls));
  const PointCloud other =
      transformed(gathered(hall, poses, there, kReach), (poses[here].inverse() * poses[there]).matrix());
  for (std::size_t k = 0; k < other.size(); ++k) cloud.positions.push_back(other.world(k).cast<float>());
  append(sums.both_m, test::wall_thickness_m(cloud, walls));
}

TEST_F(BalmHall, WallsAreAsThinAsInOnePass) {
  const Hall& hall = Hall::get();
  Thicknesses before, after;
  for (const test::MeasuredLoop& loop : hall.measured) {
    if (found_near(hall, loop) == nullptr) continue;
    Thicknesses here;
    for (const auto& [a, b] : {std::pair(loop.i, loop.j), std::pair(loop.j, loop.i)}) {
      add_thickness_at(hall, hall.before(), a, b, before);
      add_thickness_at(hall, hall.closure.poses, a, b, after);
      add_thickness_at(hall, hall.closure.poses, a, b, here);
    }
    const double single_m = median(here.single_m), both_m = median(here.both_m);
    std::cout << fmt::format("{}-{}: walls {:.4f} m thick in one pass, {:.4f} in both after, {:.2f} times\n", loop.i,
                             loop.j, single_m, both_m, both_m / single_m);
    EXPECT_LT(both_m, 1.3 * single_m) << loop.i << "-" << loop.j;
  }
  const double single_m = median(after.single_m), before_m = median(before.both_m), after_m = median(after.both_m);
  std::cout << fmt::format("all: walls {:.4f} m thick in one pass, {:.4f} in both before, {:.4f} after\n", single_m,
                           before_m, after_m);
  EXPECT_LT(after_m, 1.3 * single_m);
  EXPECT_GT(before_m, 1.6 * single_m);
}

}  // namespace
}  // namespace cmap
