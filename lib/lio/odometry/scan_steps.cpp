#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

#include "odometry/odometry_state.hpp"
#include "odometry/start.hpp"

namespace cmap {
namespace {

/// Fewer matches, or a smaller share of the points once the map has its first scans, are no registration.
constexpr std::size_t kLeastMatches = 30;
constexpr double kLeastShare = 0.15;
/// So many scans without registration, one after the other, and the map begins anew.
constexpr int kMostMissed = 10;
/// Planes spread by at least so many times the noise of ranges.
constexpr double kSpreadNoises = 3.0;
/// Without an IMU, of what the prediction of a pose was off by, velocity and rate take this share: they follow within
/// three scans, and an error early in a scan dies out (all of it would swing from scan to scan).
constexpr double kRateGain = 0.7;
/// A scan goes into the map where the sensor has moved so far since the last that did, or is one of the first: seen
/// from one place again and again, cells would be settled by the same few points.
constexpr double kInsertStep_m = 0.1, kInsertTurn_rad = 1.0 * std::numbers::pi / 180.0;
constexpr int kFirstScans = 10;
/// Of poses before a scan's begin that its first points may need: stamps and cuts of turns wander.
constexpr double kHistory_s = 0.5;

double cpu_now_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

StampedPose stamped(double time_s, const NavState& state) { return {time_s, state.position, state.rotation}; }

MotionNoise noise_of(const OdometryOptions& o) {
  MotionNoise noise{.rate = o.gyro_noise,
                    .force = o.force_noise,
                    .gyro_bias_walk = o.gyro_bias_walk,
                    .force_bias_walk = o.force_bias_walk,
                    .free_rate = o.free_rate,
                    .free_force = o.free_force};
  if (!o.use_imu) {
    // The gyro's bias stands for the rate: it walks as a rate does.
    noise.gyro_bias_walk = o.free_turn;
    noise.force_bias_walk = 0.0;
  }
  return noise;
}

PlaneMapOptions map_options(const OdometryOptions& o) {
  PlaneMapOptions map{.voxel_m = o.voxel_m,
                      .levels = o.levels,
                      .most_points = o.cell_points,
                      .forget_after_m = o.forget_after_m,
                      .plane = {}};
  map.plane.most_thickness_m = o.plane_thickness_m;
  map.plane.least_spread_m = kSpreadNoises * o.range_noise_m;
  return map;
}

double match_share(const ScanRegistration& found) {
  return static_cast<double>(found.n_matches) / std::max(1.0, static_cast<double>(found.n_points));
}

double worst_deviation(const StateMatrix& covariance, int first) {
  return std::sqrt(std::max(0.0, covariance.block<3, 3>(first, first).diagonal().maxCoeff()));
}

}  // namespace

Odometry::State::State(const OdometryOptions& o, const Eigen::Isometry3d& T,
                       const std::optional<Eigen::Isometry3d>& start, Take t)
    : options(o),
      T_imu_lidar(T),
      T_world_start(start),
      take(std::move(t)),
      noise(noise_of(o)),
      imu(o.max_imu_gap_s),
      map(map_options(o)) {}

void Odometry::State::begin(bool alone) {
  const double cpu_begin_s = cpu_now_s();
  const ScanPoints first = std::move(waiting.front());
  waiting.pop_front();
  const double until_s = alone ? first.end_s : waiting.front().end_s;
  const std::vector<ImuSample> samples = imu.between(first.begin_s - 1.0, until_s);
  const Start start = alone ? start_at_rest(first, samples, T_world_start)
                            : find_start(first, waiting.front(), samples, T_imu_lidar, T_world_start, options);
  nav = start.state;
  covariance = start.covariance;
  summary.started_in_motion = start.in_motion;
  summary.start_speed_mps = nav.velocity.norm();
  track = {stamped(first.begin_s, start.at_begin)};
  if (first.end_s > first.begin_s) track.push_back(stamped(first.end_s, nav));
  started = true;
  const MotionTrack motion(track, nav, std::nullopt);
  insert(first, motion);
  OdometryScan result;
  result.outcome = ScanOutcome::kFirst;
  deliver(first, motion, std::move(result), cpu_begin_s);
}

std::vector<MotionInput> Odometry::State::inputs(double from_s, double to_s) const {
  if (options.use_imu) return imu.inputs(from_s, to_s);
  return {{.duration_s = to_s - from_s, .rate_measured = true, .force_measured = false}};
}

MotionTrack Odometry::State::predict(double to_s, StateMatrix& predicted_covariance) const {
  Trajectory poses = track;
  NavState state = nav;
  predicted_covariance = covariance;
  double t = poses.back().time_s;
  for (const MotionInput& input : inputs(t, to_s)) {
    predicted_covariance = propagated_covariance(state, predicted_covariance, input, noise);
    state = propagated(state, input);
    poses.push_back(stamped(t += input.duration_s, state));
  }
  poses.back().time_s = to_s;
  const std::optional<double> since_s = options.use_imu ? std::nullopt : std::optional(track.back().time_s);
  return MotionTrack(std::move(poses), state, since_s);
}

ScanOutcome Odometry::State::outcome_of(const ScanRegistration& found) {
  if (found.n_matches >= kLeastMatches && (match_share(found) >= kLeastShare || n_inserted < kFirstScans)) {
    n_missed = 0;
    return ScanOutcome::kRegistered;
  }
  if (found.n_points < kLeastMatches || ++n_missed < kMostMissed) return ScanOutcome::kPredicted;
  n_missed = 0;
  return ScanOutcome::kNewMap;
}

void Odometry::State::follow_motion(const MotionTrack& motion, double duration_s) {
  const StateVector change = difference(nav, motion.predicted());
  nav.velocity = motion.predicted().velocity + kRateGain / duration_s * change.segment<3>(part::kPosition);
  nav.gyro_bias = motion.predicted().gyro_bias - kRateGain / duration_s * change.segment<3>(part::kRotation);
  const auto reset = [&](int first, double density) {
    covariance.middleRows<3>(first).setZero();
    covariance.middleCols<3>(first).setZero();
    covariance.block<3, 3>(first, first) = density * density * duration_s * Eigen::Matrix3d::Identity();
  };
  reset(part::kVelocity, options.free_force);
  reset(part::kGyroBias, options.free_turn);
}

void Odometry::State::process(const ScanPoints& scan) {
  const double cpu_begin_s = cpu_now_s();
  StateMatrix predicted_covariance;
  const MotionTrack motion = predict(scan.end_s, predicted_covariance);
  const std::vector<std::uint32_t> chosen =
      thinned(scan.positions, options.scan_voxel_m, static_cast<std::size_t>(options.scan_points));
  const ScanRegistration found = register_scan(map, scan, chosen, motion, predicted_covariance, T_imu_lidar, options);
  OdometryScan result;
  result.outcome = outcome_of(found);
  const bool registered = result.outcome == ScanOutcome::kRegistered;
  const Eigen::Vector3d before = nav.position;
  nav = registered ? found.state : motion.predicted();
  covariance = registered ? found.covariance : predicted_covariance;
  if (registered && !options.use_imu) follow_motion(motion, scan.end_s - track.back().time_s);
  summary.path_m += (nav.position - before).norm();
  if (result.outcome == ScanOutcome::kNewMap) {
    map = PlaneMap(map_options(options));
    n_inserted = 0;
  }
  result.n_chosen = found.n_points;
  result.n_matches = found.n_matches;
  result.rms_m = found.rms_m;
  result.open_shifts_world = found.open.shifts;
  result.open_turns_imu = found.open.turns;
  if (result.outcome != ScanOutcome::kPredicted && adds_to_map()) insert(scan, motion);
  deliver(scan, motion, std::move(result), cpu_begin_s);
}

bool Odometry::State::adds_to_map() const {
  return n_inserted < kFirstScans || (nav.position - at_insert.position).norm() > kInsertStep_m ||
         nav.rotation.angularDistance(at_insert.rotation) > kInsertTurn_rad;
}

void Odometry::State::insert(const ScanPoints& scan, const MotionTrack& motion) {
  ++n_inserted;
  at_insert = nav;
  const ScanPoses poses(motion, nav, T_imu_lidar, scan.end_s - scan.begin_s);
  const double beam = options.beam_noise_deg * std::numbers::pi / 180.0;
  std::vector<MapPoint> points;
  for (const std::uint32_t i : thinned(scan.positions, options.insert_voxel_m, scan.positions.size())) {
    const Eigen::Vector3d p = scan.positions[i].cast<double>();
    // Across a surface at 45 degrees.
    const double variance = 0.5 * (options.range_noise_m * options.range_noise_m + beam * beam * p.squaredNorm());
    points.push_back({poses.at(scan.before_end_s[i]).T_world_lidar * p, variance});
  }
  map.add(points, summary.path_m);
}

void Odometry::State::deliver(const ScanPoints& scan, const MotionTrack& motion, OdometryScan result,
                              double cpu_begin_s) {
  const Eigen::Isometry3d T_world_imu = T_world_body(nav), T_imu_world = T_world_imu.inverse();
  const ScanPoses poses(motion, nav, T_imu_lidar, scan.end_s - scan.begin_s);
  result.points.reserve(scan.positions.size());
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const Eigen::Vector3d world = poses.at(scan.before_end_s[i]).T_world_lidar * scan.positions[i].cast<double>();
    result.points.push_back((T_imu_world * world).cast<float>());
  }
  const double from_s = track.back().time_s;
  Trajectory corrected;
  for (const StampedPose& pose : motion.poses()) {
    const Eigen::Isometry3d T = motion.pose(pose.time_s, nav);
    if (pose.time_s > from_s || result.outcome == ScanOutcome::kFirst) {
      result.between.push_back({pose.time_s, T.translation(), Eigen::Quaterniond(T.linear())});
      corrected.push_back(result.between.back());
    } else if (pose.time_s > scan.end_s - kHistory_s) {
      corrected.push_back(pose);
    }
  }
  track = std::move(corrected);
  imu.forget_before(scan.end_s);
  result.time_s = scan.end_s;
  result.T_world_imu = T_world_imu;
  result.n_measured = scan.n_measured;
  result.n_points = scan.positions.size();
  result.position_error_m = worst_deviation(covariance, part::kPosition);
  result.rotation_error_deg = worst_deviation(covariance, part::kRotation) * 180.0 / std::numbers::pi;
  result.cpu_s = cpu_now_s() - cpu_begin_s;
  ++summary.n_scans;
  take(std::move(result));
}

}  // namespace cmap
