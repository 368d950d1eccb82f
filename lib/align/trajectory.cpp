#include "cmap/align/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "cmap/core/error.hpp"
#include "information.hpp"

namespace cmap {
namespace {

constexpr std::array<const char*, 3> kFitNames{"trajectory-first-frame", "trajectory-se3", "trajectory-sim3"};

Similarity first_frame(const PosePair& pair) {
  Similarity T;
  T.rotation = (pair.target.rotation * pair.source.rotation.conjugate()).toRotationMatrix();
  T.translation = pair.target.position - T.rotation * pair.source.position;
  return T;
}

PairMoments center_moments(std::span<const PosePair> pairs) {
  return pair_moments(pairs.size(), [&](std::size_t i) {
    return WeightedPair{pairs[i].source.position, pairs[i].target.position, 1.0};
  });
}

/// Information of positions: every pair says where its point is.
void add_observability(std::span<const PosePair> pairs, const Similarity& T, bool with_scale, Alignment& result) {
  const PairMoments moments = center_moments(pairs);
  NormalEquations information;
  for (const PosePair& pair : pairs) {
    information.add(T * pair.source.position - T * moments.mean_p, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(),
                    1.0);
  }
  const double lever_m = T.scale * std::sqrt(moments.scatter_p.trace() / moments.weight);
  tell_observability(observability(information.H, with_scale, lever_m), result);
}

/// Where one trajectory lasts about 1e3, 1e6 or 1e9 times as long as the other, its times are probably no seconds.
std::string unit_hint(const Trajectory& source, const Trajectory& target) {
  constexpr std::array<std::pair<double, const char*>, 3> kUnits{
      {{1e3, "milliseconds"}, {1e6, "microseconds"}, {1e9, "nanoseconds"}}};
  const double source_s = source.back().time_s - source.front().time_s;
  const double target_s = target.back().time_s - target.front().time_s;
  if (!(source_s > 0.0 && target_s > 0.0)) return {};
  const bool of_source = source_s > target_s;
  const double ratio = of_source ? source_s / target_s : target_s / source_s;
  for (const auto& [factor, name] : kUnits) {
    if (ratio < factor / 4.0 || ratio > factor * 4.0) continue;
    return fmt::format("; are those of the {} {}?", of_source ? "source" : "target", name);
  }
  return {};
}

void require_common_times(const Trajectory& source, const Trajectory& target, std::size_t n_pairs, double max_gap_s) {
  if (n_pairs > 0) return;
  if (source.empty() || target.empty()) throw UnsupportedError("a trajectory without poses cannot be aligned");
  throw UnsupportedError(fmt::format(
      "the times do not meet: the source is from {} to {} s, the target from {} to {} s, gaps of at most {} s{}",
      source.front().time_s, source.back().time_s, target.front().time_s, target.back().time_s, max_gap_s,
      unit_hint(source, target)));
}

}  // namespace

std::optional<StampedPose> pose_at(const Trajectory& trajectory, double time_s, double max_gap_s) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), time_s,
                                      [](const StampedPose& pose, double t) { return pose.time_s < t; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->time_s == time_s) return *after;
  if (after == trajectory.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  const double gap_s = after->time_s - before.time_s;
  if (gap_s > max_gap_s) return std::nullopt;
  const double share = (time_s - before.time_s) / gap_s;
  return StampedPose{time_s, before.position + share * (after->position - before.position),
                     before.rotation.slerp(share, after->rotation)};
}

std::string times_of_scans_and_poses(const Capture& capture, double max_gap_s) {
  return fmt::format("scans from {:.3f} to {:.3f} s, poses from {:.3f} to {:.3f} s, gaps of at most {:g} s",
                     capture.scans.front().time_s, capture.scans.back().time_s, capture.lio.front().time_s,
                     capture.lio.back().time_s, max_gap_s);
}

std::vector<Eigen::Vector3d> scanner_positions(const Capture& capture, double max_gap_s) {
  std::vector<Eigen::Vector3d> positions;
  for (const StampedFile& scan : capture.scans) {
    const auto pose = pose_at(capture.lio, scan.time_s, max_gap_s);
    if (pose) positions.push_back(pose->position + pose->rotation * capture.calibration.T_imu_lidar.translation());
  }
  if (!positions.empty()) return positions;
  if (capture.lio.empty() || capture.scans.empty()) {
    throw InputError(fmt::format("{}: scans and LiDAR-inertial poses (lio.tum) are needed", capture.folder.string()));
  }
  throw InputError(fmt::format("{}: no scan has a LiDAR-inertial pose (lio.tum) at its time: {}",
                               capture.folder.string(), times_of_scans_and_poses(capture, max_gap_s)));
}

std::vector<PosePair> pair_in_time(const Trajectory& source, const Trajectory& target, double max_gap_s) {
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : source) {
    if (const auto there = pose_at(target, pose.time_s, max_gap_s)) pairs.push_back({pose, *there});
  }
  return pairs;
}

Similarity fit_centers(std::span<const PosePair> pairs, const ScaleModel& model) {
  return fit_similarity(center_moments(pairs), model);
}

const EnumNames<TrajectoryFit>& trajectory_fit_names() {
  static const EnumNames<TrajectoryFit> names{
      {TrajectoryFit::kFirstFrame, "first-frame"}, {TrajectoryFit::kSe3, "se3"}, {TrajectoryFit::kSim3, "sim3"}};
  return names;
}

Alignment align_trajectories(const Trajectory& source, const Trajectory& target, TrajectoryFit fit, double max_gap_s) {
  const std::vector<PosePair> pairs = pair_in_time(source, target, max_gap_s);
  require_common_times(source, target, pairs.size(), max_gap_s);
  const bool with_scale = fit == TrajectoryFit::kSim3;
  const Similarity T = fit == TrajectoryFit::kFirstFrame
                           ? first_frame(pairs.front())
                           : fit_centers(pairs, with_scale ? ScaleModel::free() : ScaleModel::rigid());
  Alignment result;
  result.method = kFitNames[static_cast<std::size_t>(fit)];
  result.T_dst_src = T.matrix();
  result.scale = T.scale;
  result.n_source = source.size();
  result.n_target = target.size();
  result.n_matches = pairs.size();
  result.overlap = static_cast<double>(pairs.size()) / static_cast<double>(source.size());
  double sum_sq = 0.0;
  for (const PosePair& pair : pairs) sum_sq += (T * pair.source.position - pair.target.position).squaredNorm();
  result.rmse_m = std::sqrt(sum_sq / static_cast<double>(pairs.size()));
  if (fit == TrajectoryFit::kFirstFrame) {
    result.condition = 1.0;  // a pose is complete
  } else {
    add_observability(pairs, T, with_scale, result);
  }
  result.converged = true;
  return result;
}

}  // namespace cmap
