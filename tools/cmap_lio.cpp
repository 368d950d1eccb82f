// cmap_lio CAPTURE|RECORDING -o DIR: where a LiDAR went, and the map that it saw.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "cmap/io/lidar_scan_file.hpp"
#include "cmap/io/options_json.hpp"
#include "cmap/io/output_folder.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/recording.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "cmap/lio/lidar_mapping.hpp"
#ifdef CMAP_WITH_RENDER
#include "cmap/render/lidar_mapping_figure.hpp"
#endif
#include "command_line.hpp"
#include "files.hpp"
#include "own_figure.hpp"
#include "program.hpp"

namespace {

using cmap::ExitCode;
namespace fs = std::filesystem;

constexpr const char* kDescription =
    "LiDAR-inertial odometry with loop closure: where the sensor went, and the map that it saw. Writes to DIR\n"
    "trajectory.tum (world_T_imu at the time of each scan's last point), trajectory_imu.tum (at the IMU's stamps "
    "too),\n"
    "map.pcd, health.json (every scan's points, matches, open directions, time) and loops.json.";

constexpr const char* kExample =
    "Examples:\n"
    "  cmap_simulate small_town -o capture\n"
    "  cmap_lio capture -o lio --figure lio.png\n"
    "  cmap_lio capture -o lidar_only --no-imu\n"
    "\n"
    "A recording needs its calibration: --rig FILE, as in configs/recordings/. Odometry starts at the capture's\n"
    "T_world_imu_start; without one at the origin, upright by gravity.\n"
    "\n"
    "Exit codes: 0 done; 2 wrong usage or configuration; 3 an input is missing or malformed: if that shows under way,\n"
    "what came before is kept as trajectory.partial.tum; 70 internal error.";

struct Arguments {
  std::string input, output, rig, preset, config, figure;
  std::vector<std::string> settings;
  bool no_imu = false, no_loops = false, scans = false, print_options = false;
  cmap::CommonArguments common;
};

void add_options(cmap::CommandLine& line, Arguments& a) {
  line.add("CAPTURE", a.input, "PATH", "folder of a capture, or a recording (ROS bag, MCAP, rosbag2)").not_empty();
  line.add("-o,--output", a.output, "DIR", "folder for the results; made if need be").not_empty();
  line.add("--rig", a.rig, "FILE", "calibration and topics of a recording").not_empty();
  line.add_flag("--no-imu", a.no_imu, "LiDAR alone: velocity and rate are taken for constant between scans");
  line.add_flag("--no-loops", a.no_loops, "odometry alone, no loop closure");
  line.add_word("--preset", a.preset, cmap::odometry_preset_names(), "NAME", "options for a sensor [velodyne64]");
  line.add("--config", a.config, "FILE", "JSON file of options, see --print-options").not_empty();
  line.add("--set", a.settings, "NAME=VALUE", "one option by its name; may be repeated").one_at_a_time().not_empty();
  line.add_flag("--print-options", a.print_options, "all options as JSON, and nothing else");
  line.add_flag("--scans", a.scans, "also each scan, motion-compensated, in the IMU's axes: DIR/scans/000000.pcd");
  line.add("--figure", a.figure, "FILE", "map and path from above: .png, .jpg, .tif").not_empty();
  cmap::add_common_options(line, a.common, "no table and no progress");
}

cmap::MappingOptions resolve_options(const Arguments& a) {
  cmap::MappingOptions options;
  if (!a.preset.empty()) cmap::apply_odometry_preset(options.odometry, a.preset);
  if (!a.config.empty()) cmap::apply_odometry_config_file(options.odometry, a.config);
  for (const std::string& setting : a.settings) cmap::set_odometry_option(options.odometry, setting);
  if (a.no_imu) options.odometry.use_imu = false;
  options.close_loops = !a.no_loops;
  return options;
}

#ifdef CMAP_WITH_RENDER
void write_figure(const cmap::LidarMapping& mapping, const std::string& name, cmap::OutputFile& file) {
  cmap::write_image(cmap::draw_lidar_mapping(mapping), name, file);
}
#else
void write_figure(const cmap::LidarMapping&, const std::string&, cmap::OutputFile&) {}
#endif

/// Where messages come from, with what they need to live.
struct Source {
  std::optional<cmap::Capture> capture;
  std::optional<cmap::Recording> recording;
  cmap::CaptureCalibration calibration;
  cmap::LidarMessages next;
  double duration_s = 0.0;
  std::vector<cmap::Warning> warnings;
};

void open_capture(const Arguments& a, Source& source) {
  if (!a.rig.empty()) throw cmap::UsageError("--rig: a capture has its calibration in capture.json");
  source.capture = cmap::open_capture(
      a.input,
      {.images = cmap::Want::kNo, .imu = a.no_imu ? cmap::Want::kNo : cmap::Want::kYes, .sessions = cmap::Want::kNo});
  source.calibration = source.capture->calibration;
  source.warnings = source.capture->warnings;
  source.next = cmap::capture_messages(*source.capture, source.warnings);
  source.duration_s = source.capture->scans.back().time_s - source.capture->scans.front().time_s;
}

void open_recording(const Arguments& a, Source& source) {
  if (a.rig.empty()) throw cmap::UsageError("--rig is required: a recording does not say how its sensors sit");
  cmap::RecordingConfiguration rig = cmap::read_recording_configuration(a.rig);
  using enum cmap::RecordingRole;
  rig.options.source(kLidar).want = cmap::Want::kYes;
  rig.options.source(kImu).want = a.no_imu ? cmap::Want::kNo : cmap::Want::kYes;
  rig.options.source(kImage).want = rig.options.source(kOdometry).want = cmap::Want::kNo;
  source.calibration = rig.calibration;
  source.warnings = rig.warnings;
  source.recording.emplace(a.input, rig.options);
  source.next = [&recording = *source.recording,
                 offset_s = rig.calibration.imu_time_offset_s]() -> std::optional<cmap::LidarMessage> {
    while (std::optional<cmap::RecordedMessage> message = recording.next()) {
      if (auto* scan = std::get_if<cmap::LidarScan>(&*message)) return std::move(*scan);
      if (auto* sample = std::get_if<cmap::ImuSample>(&*message)) {
        sample->time_s += offset_s;
        return *sample;
      }
    }
    return std::nullopt;
  };
}

/// The scans as odometry has them, beside each other.
void write_scan(const fs::path& folder, std::size_t number, const cmap::OdometryScan& scan) {
  cmap::LidarScan compensated;
  compensated.timestamp_s = scan.time_s;
  compensated.positions = scan.points;
  cmap::write_lidar_scan(compensated, folder / fmt::format("{:06}.pcd", number));
}

void deliver_partial(const Arguments& a, const cmap::LidarMapping& mapping) {
  const fs::path path = fs::path(a.output) / "trajectory.partial.tum";
  cmap::write_tum_trajectory(mapping.scan_ends, path);
  throw cmap::InputError(fmt::format("{}\n{} poses before that are kept: {}", *mapping.broken_off,
                                     mapping.scan_ends.size(), path.string()));
}

void deliver(const Arguments& a, const cmap::LidarMapping& mapping, const cmap::MappingOptions& options) {
  const fs::path folder(a.output);
  const auto json = [](const nlohmann::ordered_json& value) {
    return [text = value.dump(1) + "\n"](cmap::OutputFile& file) { file.write(text); };
  };
  cmap::OutputFiles files;
  files.add(folder / "trajectory.tum",
            [&](cmap::OutputFile& file) { cmap::write_tum_trajectory(mapping.scan_ends, file); });
  files.add(folder / "trajectory_imu.tum",
            [&](cmap::OutputFile& file) { cmap::write_tum_trajectory(mapping.imu_stamps, file); });
  files.add(folder / "map.pcd", [&](cmap::OutputFile& file) { cmap::write_pcd(file, mapping.map); });
  files.add(folder / "health.json", json(cmap::health_json(mapping, options)));
  if (mapping.loops) {
    files.add(folder / "loops.json", json(cmap::loops_json(*mapping.loops, mapping.keyframes, mapping.loop_options)));
  }
  files.add(a.figure, [&](cmap::OutputFile& file) { write_figure(mapping, a.figure, file); });
  if (!a.common.quiet) cmap::print(cmap::mapping_table(mapping));
  files.commit();
}

ExitCode run(const Arguments& a) {
  const cmap::MappingOptions options = resolve_options(a);
  if (a.print_options) {
    cmap::print(cmap::options_json_of(options.odometry).dump(2) + "\n");
    return ExitCode::kDone;
  }
  if (a.input.empty() || a.output.empty()) throw cmap::UsageError("CAPTURE and --output are required");
  cmap::check_figure(a.figure);
  Source source;
  if (cmap::is_recording(a.input)) {
    open_recording(a, source);
  } else {
    open_capture(a, source);
  }
  const fs::path folder(a.output);
  cmap::make_folder(folder);
  const cmap::FolderLock lock(folder);
  cmap::require_writable(folder / "trajectory.tum");
  cmap::ProgressBar bar(!a.common.quiet);
  cmap::MappingRun how;
  how.duration_s = source.duration_s;
  how.execution = {.threads = a.common.threads,
                   .progress = [&](std::string_view stage, double done) { bar.update(stage, done); }};
  if (a.scans) {
    cmap::make_folder(folder / "scans");
    how.scan = [&, number = std::size_t{0}](const cmap::OdometryScan& scan) mutable {
      write_scan(folder / "scans", number++, scan);
    };
  }
  const cmap::LidarMapping mapping = cmap::map_lidar(source.next, source.calibration, options, how);
  if (source.recording) {
    for (const cmap::Warning& warning : source.recording->warnings()) source.warnings.push_back(warning);
  }
  cmap::print_warnings(source.warnings);
  cmap::print_warnings(mapping.warnings);
  if (mapping.broken_off) deliver_partial(a, mapping);
  deliver(a, mapping, options);
  return ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  cmap::CommandLine line("cmap_lio", kDescription, kExample);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(arguments); });
}
