#include "cmap/lio/odometry.hpp"

#include "odometry/odometry_state.hpp"

namespace cmap {

const EnumNames<ScanOutcome>& scan_outcome_names() {
  static const EnumNames<ScanOutcome> names{{ScanOutcome::kRegistered, "registered"},
                                            {ScanOutcome::kFirst, "first"},
                                            {ScanOutcome::kPredicted, "predicted"},
                                            {ScanOutcome::kNewMap, "new map"}};
  return names;
}

Odometry::Odometry(const OdometryOptions& options, const Eigen::Isometry3d& T_imu_lidar,
                   const std::optional<Eigen::Isometry3d>& T_world_start, Take take) {
  OdometryOptions checked = options;
  check_options(option_fields(checked), "odometry");
  state_ = std::make_unique<State>(options, T_imu_lidar, T_world_start, std::move(take));
}

Odometry::~Odometry() = default;

void Odometry::add(const ImuSample& sample) {
  if (!state_->options.use_imu) return;
  if (!state_->imu.add(sample)) ++state_->summary.n_late_samples;
  state_->work(false);
}

void Odometry::add(LidarScan scan) {
  state_->add(scan_points(scan, state_->options));
  state_->work(false);
}

void Odometry::finish() { state_->work(true); }

OdometrySummary Odometry::summary() const {
  OdometrySummary summary = state_->summary;
  summary.n_imu_gaps = state_->imu.n_gaps();
  summary.gravity_world = state_->nav.gravity;
  summary.gyro_bias = state_->nav.gyro_bias;
  summary.force_bias = state_->nav.force_bias;
  return summary;
}

void Odometry::State::add(ScanPoints scan) {
  if (any_scan && scan.end_s <= last_end_s) {
    ++summary.n_late_scans;
    return;
  }
  any_scan = true;
  last_end_s = scan.end_s;
  waiting.push_back(std::move(scan));
}

void Odometry::State::work(bool to_the_end) {
  if (options.use_imu && imu.empty()) return;
  while (!waiting.empty()) {
    if (options.use_imu && !started && waiting.front().begin_s < imu.first_s() - options.max_imu_gap_s) {
      ++summary.n_before_imu;
      waiting.pop_front();
      continue;
    }
    if (!started) {
      const bool two = waiting.size() > 1 && (covered(waiting[1]) || to_the_end);
      if (!two && !to_the_end) return;
      if (waiting.front().positions.empty() && waiting.size() > 1) {
        waiting.pop_front();
        continue;
      }
      begin(!two);
      continue;
    }
    if (!covered(waiting.front()) && !to_the_end) return;
    process(waiting.front());
    waiting.pop_front();
  }
}

}  // namespace cmap
