// cmap_lio CAPTURE -o DIR: LiDAR-inertial odometry.
#include <fmt/format.h>
#include "cmap/io/lidar_scan_file.hpp"
#include "cmap/io/output_folder.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "cmap/io/capture.hpp"
#include "cmap/io/option_text.hpp"
#include "cmap/io/options_json.hpp"
#include "cmap/lio/odometry_run.hpp"
#include <nlohmann/json.hpp>
int main(int argc, char** argv) {
  cmap::OdometryOptions o;
  std::string cap = argv[1], out = argv[2];
  auto fields = cmap::option_fields(o);
  for (int i = 3; i < argc; ++i) {
    std::string a = argv[i]; auto e = a.find('=');
    nlohmann::ordered_json j; j[a.substr(0, e)] = nlohmann::ordered_json::parse(a.substr(e + 1));
    cmap::set_from_json(fields, j, "arg");
  }
  auto c = cmap::open_capture(cap, {.images = cmap::Want::kNo, .sessions = cmap::Want::kNo});
  cmap::OdometryCollector col({});
  cmap::Odometry odo(o, c.calibration.T_imu_lidar, c.calibration.T_world_imu_start, [&](cmap::OdometryScan&& s) {
    fmt::print(stderr, "{:.3f} {} n {} {} {} rms {:.4f} open {} {} cpu {:.4f}\n", s.time_s, int(s.outcome), s.n_points, s.n_chosen, s.n_matches, s.rms_m, s.open_shifts_world.size(), s.open_turns_imu.size(), s.cpu_s);
    col.add(std::move(s)); });
  size_t k = 0;
  for (auto& f : c.scans) {
    auto scan = cmap::read_lidar_scan(f.path, f.time_s);
    while (k < c.imu.size() && c.imu[k].time_s < f.time_s + 0.3) odo.add(c.imu[k++]);
    odo.add(std::move(scan));
  }
  odo.finish();
  auto run = col.finish(odo.summary());
  double sum = 0; for (auto& s : run.scans) sum += s.cpu_s;
  auto& S = run.summary;
  fmt::print("scans {} path {:.2f} motion {} speed {:.2f} g {:.3f} {:.3f} {:.3f} bg {:.5f} {:.5f} {:.5f} ba {:.4f} {:.4f} {:.4f} cpu/scan {:.2f} ms\n", S.n_scans, S.path_m, S.started_in_motion, S.start_speed_mps, S.gravity_world.x(), S.gravity_world.y(), S.gravity_world.z(), S.gyro_bias.x(), S.gyro_bias.y(), S.gyro_bias.z(), S.force_bias.x(), S.force_bias.y(), S.force_bias.z(), 1e3*sum/double(S.n_scans));
  cmap::make_folder(out);
  cmap::write_tum_trajectory(run.scan_ends, out + "/trajectory.tum");
  cmap::write_tum_trajectory(run.imu_stamps, out + "/trajectory_imu.tum");
}
