#include "loops/loop_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cmap/core/parallel.hpp"
#include "loops/drift_bound.hpp"
#include "loops/submap_alignment.hpp"

namespace cmap {
namespace {

constexpr double kRad_deg = 180.0 / std::numbers::pi;

/// One pair on its way through the check.
class PairCheck {
 public:
  PairCheck(const LoopProposal& proposal, const LoopInputs& inputs, const LoopOptions& options)
      : proposal_(proposal), inputs_(inputs), options_(options) {
    found_.from = from().center;
    found_.to = to().center;
    found_.source = proposal.source;
    found_.path_m = to().path_m - from().path_m;
    found_.drift_bound_m = drift_bound(found_.path_m, options).m;
    found_.pose_distance_m = odometry().translation().norm();
    const RingMatch match = best_turn(view(proposal.to).ring, view(proposal.from).ring);
    found_.descriptor_score = match.similarity;
    ring_yaw_rad_ = match.yaw_rad;
  }

  LoopCandidate run(const SubmapSurface& from_surface, const SubmapSurface& to_surface) {
    const std::vector<Eigen::Isometry3d> level_starts = starts();
    found_.yaw_rad = yaw_of(level_starts.front());
    const SubmapAlignment aligned = align_submaps(from_surface, to_surface, level_starts, options_);
    found_.T_from_to = to_level(from()).inverse() * aligned.T_from_to * to_level(to());
    found_.verdict = aligned.judgment;
    found_.rmse_m = aligned.rmse_m;
    found_.error_m = aligned.error_m;
    found_.inlier_share = aligned.agreement.share;
    for (RivalPose& rival : found_.verdict.rivals) {
      const Eigen::Isometry3d T(rival.T_dst_src);
      rival.T_dst_src = (to_level(from()).inverse() * T * to_level(to())).matrix();
    }
    decide(aligned.is_aligned);
    return std::move(found_);
  }

 private:
  const Submap& from() const { return inputs_.submaps[proposal_.from]; }
  const Submap& to() const { return inputs_.submaps[proposal_.to]; }
  const SubmapView& view(std::size_t submap) const { return inputs_.views[submap]; }
  const Eigen::Isometry3d& odometry_pose(const Submap& s) const { return inputs_.keyframes[s.center].T_world_body; }
  Eigen::Isometry3d odometry() const { return odometry_pose(from()).inverse() * odometry_pose(to()); }
  /// From the body's axes to the submap's level frame.
  Eigen::Isometry3d to_level(const Submap& s) const {
    return level_frame(odometry_pose(s)).inverse() * odometry_pose(s);
  }
  static double yaw_of(const Eigen::Isometry3d& T) { return std::atan2(T.linear()(1, 0), T.linear()(0, 0)); }

  /// By the poses of this round, in level frames.
  Eigen::Isometry3d predicted() const {
    const Eigen::Isometry3d T = inputs_.poses[from().center].inverse() * inputs_.poses[to().center];
    return to_level(from()) * T * to_level(to()).inverse();
  }

  Eigen::Isometry3d start_at(const PlanarPose& planar) const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(planar.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.translation() << planar.shift_m, view(proposal_.from).ground_m - view(proposal_.to).ground_m;
    return T;
  }

  /// Headings in which the views are laid on each other: what the descriptors say, where that is within the drift, or
  /// about what the poses say.
  std::vector<double> yaws(double predicted_rad) const {
    constexpr double kStep_rad = 1.5 / kRad_deg;
    std::vector<double> yaws;
    for (const double yaw_rad : {ring_yaw_rad_, ring_yaw_rad_ + std::numbers::pi}) {
      const double off_rad = std::abs(std::remainder(yaw_rad - predicted_rad, 2.0 * std::numbers::pi));
      if (off_rad <= drift_bound(found_.path_m, options_).rad + kStep_rad) yaws.push_back(yaw_rad);
    }
    if (proposal_.source == LoopSource::kDescriptor && !yaws.empty()) return yaws;
    for (const int i : {0, -1, 1, -2, 2}) yaws.push_back(predicted_rad + i * kStep_rad);
    return yaws;
  }

  /// Where ICP starts, the likeliest first: where the views from above lie on each other best, where else they do so
  /// nearly as well, and where the poses have it.
  std::vector<Eigen::Isometry3d> starts() const {
    constexpr double kNearlyAsWell = 0.8;
    const Eigen::Isometry3d T = predicted();
    const double drift_m = proposal_.source == LoopSource::kCorrected ? options_.drift_m : found_.drift_bound_m;
    const std::vector<PlanarPose> planar =
        best_planar_poses(view(proposal_.to).above, image_of(view(proposal_.from).above), yaws(yaw_of(T)),
                          T.translation().head<2>(), drift_m);
    std::vector<Eigen::Isometry3d> starts;
    for (const PlanarPose& pose : planar) {
      if (pose.score >= kNearlyAsWell * planar.front().score) starts.push_back(start_at(pose));
    }
    const bool is_near = difference(T, starts.front()).m < options_.voxel_m;
    if (proposal_.source != LoopSource::kDescriptor && !is_near) starts.push_back(T);
    return starts;
  }

  void decide(bool is_aligned) {
    found_.reason = found_.verdict.reason;
    if (!is_aligned) return;
    const MotionDifference correction = difference(found_.T_from_to, odometry());
    found_.correction_m = correction.m;
    found_.correction_deg = correction.rad * kRad_deg;
    const DriftBound bound = drift_bound(found_.path_m, options_);
    if (found_.verdict.verdict != Verdict::kDetermined) return;
    if (!correction.within(bound)) {
      found_.reason = fmt::format(
          "it moves the pose by {:.2f} m and {:.1f} deg, and odometry drifts by {:.2f} m and "
          "{:.1f} deg at most",
          correction.m, found_.correction_deg, bound.m, bound.rad * kRad_deg);
      return;
    }
    found_.accepted = true;
  }

  const LoopProposal& proposal_;
  const LoopInputs& inputs_;
  const LoopOptions& options_;
  LoopCandidate found_;
  double ring_yaw_rad_ = 0.0;
};

/// First places of runs with one `to`, and the end.
std::vector<std::size_t> runs_of(std::span<const LoopProposal> proposals) {
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < proposals.size(); ++i) {
    if (i == 0 || proposals[i].to != proposals[i - 1].to) first.push_back(i);
  }
  first.push_back(proposals.size());
  return first;
}

}  // namespace

std::vector<LoopCandidate> checked(std::span<const LoopProposal> proposals, const LoopInputs& inputs,
                                   const LoopOptions& options) {
  const auto surface = [&](std::size_t submap) {
    return SubmapSurface(points_of(inputs.submaps[submap], inputs.keyframes, 0.5 * options.voxel_m), options);
  };
  std::vector<LoopCandidate> candidates(proposals.size());
  const std::vector<std::size_t> runs = runs_of(proposals);
  parallel_chunks(runs.size() - 1, 1, [&](std::size_t run, std::size_t) {
    const SubmapSurface to = surface(proposals[runs[run]].to);
    for (std::size_t i = runs[run]; i < runs[run + 1]; ++i) {
      candidates[i] = PairCheck(proposals[i], inputs, options).run(surface(proposals[i].from), to);
    }
  });
  return candidates;
}

}  // namespace cmap
