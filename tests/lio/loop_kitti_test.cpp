#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "cmap/align/umeyama.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "loops/loop_graph.hpp"
#include "loops/loop_proposals.hpp"

// KITTI 07 by two odometries, whose end comes back to its start. The data have poses and no scans: what poses alone
// allow is to propose loops, and to close the graph with loops that somebody else measured. The truth stands for the
// ICP here; how far ICP is from it is held by the tests with points.

namespace cmap {
namespace {

using Poses = std::vector<Eigen::Isometry3d>;

std::filesystem::path kitti_folder() {
  if (const char* folder = std::getenv("CMAP_DATA_DIR")) return std::filesystem::path(folder) / "kitti_trajectories";
  const char* source = std::getenv("CMAP_SOURCE_DIR");  // set by CTest
  return std::filesystem::path(source ? source : ".") / "../shared/data/kitti_trajectories";
}

/// KITTI's camera looks along z, y down; here x is ahead and z up.
Poses kitti_poses(const char* name) {
  Eigen::Isometry3d T_body_camera = Eigen::Isometry3d::Identity();
  T_body_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Poses poses;
  for (const StampedPose& pose : read_trajectory(kitti_folder() / name).poses) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = pose.rotation.toRotationMatrix();
    T.translation() = pose.position;
    poses.push_back(T_body_camera * T * T_body_camera.inverse());
  }
  return poses;
}

/// RMS distance of positions after the best rigid fit.
double rms_m(const Poses& poses, const Poses& truth) {
  std::vector<Eigen::Vector3d> p, q;
  for (const Eigen::Isometry3d& T : poses) p.push_back(T.translation());
  for (const Eigen::Isometry3d& T : truth) q.push_back(T.translation());
  const Similarity fit = umeyama(p, q, ScaleModel::rigid());
  double sq_sum = 0.0;
  for (std::size_t k = 0; k < p.size(); ++k) sq_sum += (fit * p[k] - q[k]).squaredNorm();
  return std::sqrt(sq_sum / static_cast<double>(p.size()));
}

/// What the motion between two poses is off by.
double gap_m(const Poses& poses, const Poses& truth, std::size_t from, std::size_t to) {
  return ((poses[from].inverse() * poses[to]).translation() - (truth[from].inverse() * truth[to]).translation()).norm();
}

class LoopKitti : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kitti_folder())) {
      GTEST_SKIP() << "no real data: " << kitti_folder() << " is missing; set CMAP_DATA_DIR";
    }
    truth_ = kitti_poses("truth_07.txt");
    odometry_ = kitti_poses(GetParam());
    for (std::size_t k = 0; k < odometry_.size(); ++k) {
      keyframes_.push_back({0.1 * static_cast<double>(k), odometry_[k], {Eigen::Vector3f::Zero()}});
    }
    options_.submap_spacing_m = 1.0;
    options_.gravity_sigma_deg = 0.0;  // odometries without an IMU
    submaps_ = submaps_of(keyframes_, path_lengths_m(keyframes_), options_);
    proposals_ = pose_proposals(submaps_, odometry_, options_);
  }
  LoopOptions options_;
  Poses truth_, odometry_;
  std::vector<Keyframe> keyframes_;
  std::vector<Submap> submaps_;
  std::vector<LoopProposal> proposals_;
};

TEST_P(LoopKitti, PosesProposeEveryPlaceThatIsSeenAgain) {
  constexpr double kSame_m = 5.0;
  int n_revisits = 0, n_proposed = 0;
  for (std::size_t to = 0; to < submaps_.size(); ++to) {
    const auto distance_m = [&](std::size_t from) {
      return (truth_[submaps_[from].center].translation() - truth_[submaps_[to].center].translation()).norm();
    };
    bool is_revisit = false;
    for (std::size_t from = 0; from < to; ++from) {
      const bool is_later = submaps_[to].path_m - submaps_[from].path_m >= options_.min_path_m;
      is_revisit |= is_later && distance_m(from) < kSame_m;
    }
    if (!is_revisit) continue;
    ++n_revisits;
    n_proposed += std::any_of(proposals_.begin(), proposals_.end(), [&](const LoopProposal& p) {
      return p.to == to && distance_m(p.from) < kSame_m + options_.drift_m;
    });
  }
  EXPECT_GT(n_revisits, 5);
  EXPECT_EQ(n_proposed, n_revisits);
}

TEST_P(LoopKitti, LoopsThatAreMeasuredCloseTheGaps) {
  constexpr double kSeen_m = 10.0;  // what scans of one place would show
  LoopClosure closure;
  for (const LoopProposal& p : proposals_) {
    LoopCandidate loop;
    loop.from = submaps_[p.from].center;
    loop.to = submaps_[p.to].center;
    loop.T_from_to = truth_[loop.from].inverse() * truth_[loop.to];
    loop.accepted = loop.T_from_to.translation().norm() < kSeen_m;
    if (loop.accepted) closure.candidates.push_back(loop);
  }
  ASSERT_FALSE(closure.candidates.empty());
  close_graph(keyframes_, options_, closure);
  EXPECT_EQ(closure.n_loops, closure.candidates.size());
  double before_m = 0.0, after_m = 0.0;
  for (const LoopCandidate& loop : closure.candidates) {
    before_m = std::max(before_m, gap_m(odometry_, truth_, loop.from, loop.to));
    after_m = std::max(after_m, gap_m(closure.poses, truth_, loop.from, loop.to));
  }
  const std::size_t last = truth_.size() - 1;
  std::cout << fmt::format(
      "{}: {} loops; largest gap {:.2f} m before, {:.2f} after; end to start {:.2f} m off before, {:.2f} after; rigid "
      "fit {:.2f} m RMS before, {:.2f} after\n",
      GetParam(), closure.n_loops, before_m, after_m, gap_m(odometry_, truth_, 0, last),
      gap_m(closure.poses, truth_, 0, last), rms_m(odometry_, truth_), rms_m(closure.poses, truth_));
  EXPECT_LT(after_m, 0.3);
  EXPECT_LT(after_m, 0.5 * before_m);
  EXPECT_LT(gap_m(closure.poses, truth_, 0, last), 0.3);
}

INSTANTIATE_TEST_SUITE_P(Odometries, LoopKitti, ::testing::Values("kiss_icp_07.txt", "steam_icp_07.txt"));

}  // namespace
}  // namespace cmap
