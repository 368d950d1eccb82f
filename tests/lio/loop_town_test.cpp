#include "lio/loop_town.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "cmap/lio/loop_closure.hpp"
#include "loops/submaps.hpp"

// A drive through a simulated town that comes back into its first street from the other end, in the other lane.
// benchmarks/loops has the same over 3 km.

namespace cmap {
namespace {

test::LoopDriveOptions small_drive() {
  test::LoopDriveOptions options;
  options.town.blocks_x = 4;
  options.town.blocks_y = 3;
  options.crossings = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 0}, {0, 0}};
  options.lidar.azimuth_steps = 600;
  return options;
}

/// The drive with its loops closed, once for all tests.
struct Town {
  test::LoopDrive drive = test::simulated_drive(small_drive());
  LoopOptions options;
  LoopClosure closure = close_loops(drive.keyframes, options, {.threads = 2});

  Eigen::Isometry3d motion(std::size_t from, std::size_t to) const {
    return drive.truth[from].inverse() * drive.truth[to];
  }
  static const Town& get() {
    static const Town town;
    return town;
  }
};

TEST(LoopTown, EveryAcceptedLoopIsRight) {
  const Town& town = Town::get();
  EXPECT_GT(town.closure.n_loops, 10U);
  for (const LoopCandidate& c : town.closure.candidates) {
    if (!c.accepted) continue;
    const Eigen::Isometry3d off = town.motion(c.from, c.to).inverse() * c.T_from_to;
    EXPECT_LT(off.translation().norm(), 0.15) << c.from << "-" << c.to;
    EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.01) << c.from << "-" << c.to;
    EXPECT_LT(c.residual, town.options.largest_residual);
  }
}

TEST(LoopTown, PlacesSeenAgainTheOtherWayRoundAreFound) {
  const Town& town = Town::get();
  const std::vector<double> paths_m = path_lengths_m(town.drive.keyframes);
  const std::vector<Submap> submaps = submaps_of(town.drive.keyframes, paths_m, town.options);
  int n_revisits = 0, n_found = 0;
  for (const Submap& to : submaps) {
    const bool is_revisit = std::any_of(submaps.begin(), submaps.end(), [&](const Submap& from) {
      return to.path_m - from.path_m >= town.options.min_path_m &&
             town.motion(from.center, to.center).translation().norm() < 5.0;
    });
    if (!is_revisit) continue;
    ++n_revisits;
    n_found += std::any_of(town.closure.candidates.begin(), town.closure.candidates.end(),
                           [&](const LoopCandidate& c) { return c.accepted && c.to == to.center; });
  }
  EXPECT_GE(n_revisits, 8);
  EXPECT_GE(n_found, 0.8 * n_revisits);
}

TEST(LoopTown, TheEndMeetsTheStart) {
  const Town& town = Town::get();
  const auto end_error_m = [&](const Eigen::Isometry3d& first, const Eigen::Isometry3d& last) {
    const Eigen::Isometry3d expected = town.motion(0, town.drive.truth.size() - 1);
    return ((first.inverse() * last).translation() - expected.translation()).norm();
  };
  const std::vector<Keyframe>& keyframes = town.drive.keyframes;
  const double before_m = end_error_m(keyframes.front().T_world_body, keyframes.back().T_world_body);
  const double after_m = end_error_m(town.closure.poses.front(), town.closure.poses.back());
  std::cout << "end to start: " << before_m << " m off before, " << after_m << " after\n";
  EXPECT_GT(before_m, 0.5);
  EXPECT_LT(after_m, 0.1);
}

TEST(LoopTown, OneThreadFindsTheSame) {
  const Town& town = Town::get();
  const LoopClosure again = close_loops(town.drive.keyframes, town.options, {.threads = 1});
  ASSERT_EQ(again.candidates.size(), town.closure.candidates.size());
  for (std::size_t i = 0; i < again.candidates.size(); ++i) {
    EXPECT_TRUE(again.candidates[i].T_from_to.matrix() == town.closure.candidates[i].T_from_to.matrix());
    EXPECT_EQ(again.candidates[i].reason, town.closure.candidates[i].reason);
  }
  for (std::size_t k = 0; k < again.poses.size(); ++k) {
    EXPECT_TRUE(again.poses[k].matrix() == town.closure.poses[k].matrix());
  }
}

// Where the drift bound is not to be relied on, what the submaps show must tell.
TEST(LoopTown, WithoutADriftBoundNothingWrongIsAccepted) {
  const Town& town = Town::get();
  LoopOptions options = town.options;
  options.drift_m = options.max_drift_m = 60.0;
  options.drift_deg = options.max_drift_deg = 180.0;
  options.rounds = 1;
  options.submap_spacing_m = 15.0;
  const LoopClosure closure = close_loops(town.drive.keyframes, options);
  EXPECT_GT(closure.n_loops, 2U);
  for (const LoopCandidate& c : closure.candidates) {
    if (!c.accepted) continue;
    const Eigen::Isometry3d off = town.motion(c.from, c.to).inverse() * c.T_from_to;
    EXPECT_LT(off.translation().norm(), 0.3) << c.from << "-" << c.to;
  }
}

}  // namespace
}  // namespace cmap
