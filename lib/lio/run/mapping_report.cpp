#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cmap/core/version.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/io/options_json.hpp"
#include "cmap/lio/lidar_mapping.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Json directions(const std::vector<Eigen::Vector3d>& all) {
  Json rows = Json::array();
  for (const Eigen::Vector3d& v : all) rows.push_back(numbers(v));
  return rows;
}

Json scan_json(const OdometryScan& scan) {
  return {{"time_s", scan.time_s},
          {"outcome", name_of(scan.outcome, scan_outcome_names())},
          {"points", scan.n_measured},
          {"points_in_range", scan.n_points},
          {"points_registered", scan.n_chosen},
          {"matches", scan.n_matches},
          {"rms_m", scan.n_matches > 0 ? Json(scan.rms_m) : Json(nullptr)},
          {"open_shifts_world", directions(scan.open_shifts_world)},
          {"open_turns_imu", directions(scan.open_turns_imu)},
          {"position_error_m", scan.position_error_m},
          {"rotation_error_deg", scan.rotation_error_deg},
          {"cpu_s", scan.cpu_s}};
}

double median_of(const std::vector<OdometryScan>& scans, double OdometryScan::*member) {
  std::vector<double> values;
  for (const OdometryScan& scan : scans) values.push_back(scan.*member);
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

Json summary_json(const OdometrySummary& s) {
  return {{"scans", s.n_scans},
          {"path_m", s.path_m},
          {"start", s.started_in_motion ? "in motion" : "at rest"},
          {"start_speed_mps", s.start_speed_mps},
          {"gravity_world_mps2", numbers(s.gravity_world)},
          {"gyro_bias_radps", numbers(s.gyro_bias)},
          {"force_bias_mps2", numbers(s.force_bias)},
          {"scans_before_imu", s.n_before_imu},
          {"late_scans", s.n_late_scans},
          {"late_imu_samples", s.n_late_samples},
          {"imu_gaps", s.n_imu_gaps}};
}

}  // namespace

Json health_json(const LidarMapping& mapping, const MappingOptions& options) {
  Json warnings = Json::array(), scans = Json::array();
  for (const Warning& warning : mapping.warnings)
    warnings.push_back({{"id", warning.id}, {"message", warning.message}});
  for (const OdometryScan& scan : mapping.scans) scans.push_back(scan_json(scan));
  return {{"schema", "cmap.lio/1"},
          {"tool", {{"name", "cmap_lio"}, {"version", kVersion}}},
          {"pose", "world_T_imu at the time of the last point of each scan"},
          {"options", options_json_of(options.odometry)},
          {"summary", summary_json(mapping.summary)},
          {"broken_off", mapping.broken_off ? Json(*mapping.broken_off) : Json(nullptr)},
          {"warnings", warnings},
          {"scans", scans}};
}

std::string mapping_table(const LidarMapping& mapping) {
  const OdometrySummary& s = mapping.summary;
  const double seconds = mapping.scan_ends.back().time_s - mapping.scan_ends.front().time_s;
  double cpu_s = 0.0, share = 0.0;
  std::size_t n_open = 0, n_registered = 0;
  for (const OdometryScan& scan : mapping.scans) {
    cpu_s += scan.cpu_s;
    if (!scan.open_shifts_world.empty() || !scan.open_turns_imu.empty()) ++n_open;
    if (scan.outcome != ScanOutcome::kRegistered) continue;
    ++n_registered;
    share += static_cast<double>(scan.n_matches) / static_cast<double>(scan.n_chosen);
  }
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("{:<18} {}\n", name, value);
  };
  line("scans", fmt::format("{}, of which {} registered; {:.1f} s", s.n_scans, n_registered, seconds));
  line("path", fmt::format("{:.2f} m", s.path_m));
  line("start", s.started_in_motion ? fmt::format("in motion, {:.2f} m/s", s.start_speed_mps) : "at rest");
  if (n_registered > 0) {
    line("matches", fmt::format("{:.0f} % of the points that take part, {:.1f} cm from their planes (median)",
                                100.0 * share / static_cast<double>(n_registered),
                                100.0 * median_of(mapping.scans, &OdometryScan::rms_m)));
  }
  line("open directions", n_open == 0 ? "none" : fmt::format("in {} scans", n_open));
  if (mapping.loops) {
    line("loops", fmt::format("{} of {} candidates; largest change {:.2f} m", mapping.loops->n_loops,
                              mapping.loops->candidates.size(), mapping.loops->largest_change_m));
  }
  line("map", fmt::format("{} points", mapping.map.size()));
  line("time a scan",
       fmt::format("{:.1f} ms of one core (median)", 1e3 * median_of(mapping.scans, &OdometryScan::cpu_s)));
  return text;
}

}  // namespace cmap
