#include "cmap/lio/lidar_mapping.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

/// Hands messages to the odometry until they end; why, where that was too early.
std::optional<std::string> take_messages(const LidarMessages& next, Odometry& odometry, const MappingRun& run) {
  std::optional<double> first_s;
  try {
    while (const std::optional<LidarMessage> message = next()) {
      throw_if_stopped();
      if (const auto* scan = std::get_if<LidarScan>(&*message)) {
        if (!first_s) first_s = scan->timestamp_s;
        const double done = run.duration_s > 0.0 ? (scan->timestamp_s - *first_s) / run.duration_s : 0.0;
        report_progress("odometry", std::clamp(done, 0.0, 1.0));
        odometry.add(*scan);
      } else {
        odometry.add(std::get<ImuSample>(*message));
      }
    }
  } catch (const InputError& error) {
    odometry.finish();
    return error.what();
  }
  odometry.finish();
  return std::nullopt;
}

void warn(LidarMapping& mapping, const char* id, std::size_t n, const char* what) {
  if (n > 0) mapping.warnings.push_back({id, fmt::format("{} {}", n, what)});
}

std::size_t count(const std::vector<OdometryScan>& scans, ScanOutcome outcome) {
  return static_cast<std::size_t>(std::ranges::count(scans, outcome, &OdometryScan::outcome));
}

void add_warnings(LidarMapping& mapping) {
  const OdometrySummary& s = mapping.summary;
  warn(mapping, "scans_before_imu", s.n_before_imu, "scans came before the IMU began, and are left out");
  warn(mapping, "late_scans", s.n_late_scans, "scans end no later than the one before them, and are left out");
  warn(mapping, "late_imu", s.n_late_samples, "IMU samples are no later than the one before them, and are left out");
  warn(mapping, "imu_gaps", s.n_imu_gaps, "gaps in the IMU were bridged by the last rate and velocity");
  warn(mapping, "predicted_scans", count(mapping.scans, ScanOutcome::kPredicted),
       "scans are placed by prediction alone: empty, or too few of their points fit the map");
  for (const OdometryScan& scan : mapping.scans) {
    if (scan.outcome != ScanOutcome::kNewMap) continue;
    mapping.warnings.push_back(
        {"new_map", fmt::format("at {:.3f} s scans no longer fit what was seen before ({} of {} points): a jump, a gap "
                                "or a wrong calibration. The map begins anew there; how it lies to the part before is "
                                "by prediction alone",
                                scan.time_s, scan.n_matches, scan.n_chosen)});
  }
  const auto open = static_cast<std::size_t>(std::ranges::count_if(mapping.scans, [](const OdometryScan& scan) {
    return !scan.open_shifts_world.empty() || !scan.open_turns_imu.empty();
  }));
  warn(mapping, "open_directions", open,
       "scans leave a direction open (health.json names it): prediction decided there");
}

void require_poses(const OdometryRun& found, const OdometryOptions& options, std::optional<std::string> broken_off) {
  if (!found.scans.empty()) {
    const bool any = std::ranges::any_of(found.scans, [](const OdometryScan& scan) { return scan.n_points > 0; });
    if (any) return;
    std::size_t n = 0;
    for (const OdometryScan& scan : found.scans) n += scan.n_measured;
    throw InputError(
        fmt::format("no scan has a point between {:g} and {:g} m ({} points in {} scans): min_range_m, "
                    "max_range_m, or the unit of the points",
                    options.min_range_m, options.max_range_m, n, found.scans.size()));
  }
  if (broken_off) throw InputError(*broken_off);
  if (found.summary.n_before_imu > 0) {
    throw InputError(
        fmt::format("all {} scans come before the IMU begins: other clocks? time_offset.imu_s in "
                    "capture.json, or --no-imu",
                    found.summary.n_before_imu));
  }
  throw InputError(options.use_imu ? "no IMU samples, or no scan within their times; --no-imu does without"
                                   : "no scan to work on");
}

std::vector<Eigen::Isometry3d> poses_of(const std::vector<Keyframe>& keyframes) {
  std::vector<Eigen::Isometry3d> poses;
  for (const Keyframe& keyframe : keyframes) poses.push_back(keyframe.T_world_body);
  return poses;
}

void close(LidarMapping& mapping, const MappingOptions& options) {
  mapping.loop_options = options.loops ? *options.loops : loop_options_for(mapping.keyframes);
  // Without an IMU nothing says which way is down: odometry's roll and pitch are as good as its heading.
  if (!options.loops && !options.odometry.use_imu) mapping.loop_options.gravity_sigma_deg = 0.0;
  mapping.loops = close_loops(mapping.keyframes, mapping.loop_options);
  std::vector<double> times_s;
  for (const Keyframe& keyframe : mapping.keyframes) times_s.push_back(keyframe.time_s);
  const std::vector<Eigen::Isometry3d> before = poses_of(mapping.keyframes);
  mapping.scan_ends = corrected(mapping.scan_ends, times_s, before, mapping.loops->poses);
  mapping.imu_stamps = corrected(mapping.imu_stamps, times_s, before, mapping.loops->poses);
}

}  // namespace

LidarMapping map_lidar(const LidarMessages& next, const CaptureCalibration& calibration, const MappingOptions& options,
                       const MappingRun& run) {
  const ExecutionScope scope(run.execution);
  OdometryCollector collector(options.keyframes);
  Odometry odometry(options.odometry, calibration.T_imu_lidar, calibration.T_world_imu_start, [&](OdometryScan&& scan) {
    if (run.scan) run.scan(scan);
    collector.add(std::move(scan));
  });
  LidarMapping mapping;
  mapping.broken_off = take_messages(next, odometry, run);
  OdometryRun found = collector.finish(odometry.summary());
  require_poses(found, options.odometry, mapping.broken_off);
  mapping.scan_ends = std::move(found.scan_ends);
  mapping.imu_stamps = std::move(found.imu_stamps);
  mapping.keyframes = std::move(found.keyframes);
  mapping.scans = std::move(found.scans);
  mapping.summary = found.summary;
  add_warnings(mapping);
  report_progress("loops", 0.0);
  if (options.close_loops && !mapping.broken_off && mapping.keyframes.size() > 1) close(mapping, options);
  report_progress("map", 0.0);
  const std::vector<Eigen::Isometry3d> poses = mapping.loops ? mapping.loops->poses : poses_of(mapping.keyframes);
  mapping.map = keyframe_map(mapping.keyframes, poses, options.keyframes.voxel_m);
  return mapping;
}

}  // namespace cmap
