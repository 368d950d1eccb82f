// cmap_colorize CAPTURE -o MAP.ply: a LiDAR map gets its colors from images along known poses.

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "cmap/colorize/colorize.hpp"
#include "cmap/colorize/colorize_report.hpp"
#include "cmap/colorize/refine_extrinsic.hpp"
#include "cmap/colorize/scan_map.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/core/progress.hpp"
#include "cmap/geometry/color.hpp"
#include "cmap/geometry/rotation.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/io/image_file.hpp"
#include "cmap/io/option_text.hpp"
#include "cmap/io/options_json.hpp"
#include "cmap/io/output_file.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "cmap/report/report.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "program.hpp"
#include "recording_input.hpp"

namespace {

using cmap::ExitCode;

constexpr const char* kDescription =
    "Colors a LiDAR map from the images of a capture along known poses: the scans, placed along lio.tum, or --map.\n"
    "Points behind surfaces do not take their color; of many views the weighted median; exposures are equalized.";

constexpr const char* kExample =
    "Examples:\n"
    "  cmap_simulate small_town -o capture\n"
    "  cmap_colorize capture -o colored.ply --voxel 0.1\n"
    "  cmap_colorize capture -o turned.ply --turn 0,1,0 --time-offset 0.02\n"
    "\n"
    "Exit codes: 0 done; 2 wrong usage; 3 an input is missing or malformed, the capture has no images, scans or "
    "poses,\n"
    "no image has a pose at its time, or none sees a point; 4 what --refine-extrinsic asks for cannot be told from\n"
    "these images; 70 internal error.";

enum class Images { kAll, kEven, kOdd };

struct Arguments {
  std::string capture, output, map, trajectory, extrinsic, json, refined;
  std::optional<double> voxel_m;
  Images images = Images::kAll;
  int every = 1;
  double time_offset_s = 0.0;
  std::vector<double> turn_deg, shift_m;
  std::vector<std::string> settings;
  bool leave_out_unseen = false, refine = false, print_options = false;
  cmap::RecordingArguments recording;
  cmap::CommonArguments common;

  std::vector<std::string> outputs() const { return {output, json, refined}; }
};

void add_options(cmap::CommandLine& line, Arguments& a) {
  constexpr double kLeast = 1e-6, kMost = 1e6;
  line.add("CAPTURE", a.capture, "PATH", "folder of a capture, or a recording").not_empty();
  line.add("-o,--output", a.output, "FILE.ply", "colored map to write").not_empty();
  line.add("--map", a.map, "FILE", "map to color, in the world of the poses [the scans along the poses]").not_empty();
  line.add("--trajectory", a.trajectory, "FILE", "poses world_T_imu [the capture's lio.tum]").not_empty();
  line.add("--voxel", a.voxel_m, "M", "the map is thinned to this [scans: 0.1; --map: not thinned]")
      .between(kLeast, kMost);
  line.add_flag("--leave-out-unseen", a.leave_out_unseen,
                "without the points that no image sees; else they stay, with NaN for a color");
  line.add_choice("--images", a.images, {{Images::kAll, "all"}, {Images::kEven, "even"}, {Images::kOdd, "odd"}},
                  "WHICH", "all, or the even or odd ones of images.csv [all]");
  line.add("--every", a.every, "N", "every Nth image alone [1]").between(1, 1'000'000);
  line.add("--extrinsic", a.extrinsic, "FILE", "4x4 matrix T_lidar_camera [the capture's]").not_empty();
  line.add("--turn", a.turn_deg, "X,Y,Z",
           "turns the camera by this rotation vector in its own frame, degrees: to see what it does")
      .with_commas()
      .values(3, 3);
  line.add("--shift", a.shift_m, "X,Y,Z", "moves the camera in the LiDAR's frame, meters: likewise")
      .with_commas()
      .values(3, 3);
  line.add("--time-offset", a.time_offset_s, "S", "added to the images' times, beside the capture's own [0]")
      .between(-1e6, 1e6);
  line.add_flag("--refine-extrinsic", a.refine,
                "check of the calibration: the change for which the images agree best; it is told, never applied");
  line.add("--extrinsic-output", a.refined, "FILE", "the matrix T_lidar_camera that --refine-extrinsic finds, to write")
      .not_empty();
  line.add("--set", a.settings, "NAME=VALUE", "one option by its name; may be repeated").one_at_a_time().not_empty();
  line.add_flag("--print-options", a.print_options, "all options as JSON, and nothing else");
  line.add("--json", a.json, "FILE", "everything about the result, to write").not_empty();
  cmap::add_recording_options(line, a.recording);
  cmap::add_common_options(line, a.common, "no table, no warnings and no progress");
}

cmap::ColorizeOptions options_of(const Arguments& a) {
  cmap::ColorizeOptions options;
  for (const std::string& setting : a.settings) {
    const auto [name, value] = cmap::read_assignment(setting, "name=value");
    cmap::set_from_json(cmap::fields_of(options), {{name, value}}, "options");
  }
  return options;
}

cmap::ImageSubset subset_of(const Arguments& a) {
  if (a.images == Images::kAll) return {static_cast<std::size_t>(a.every), 0};
  if (a.every != 1) throw cmap::UsageError("--every with --images even or odd: choose one of them");
  return {2, a.images == Images::kOdd ? 1u : 0u};
}

/// The calibration as the command line changes it.
Eigen::Isometry3d extrinsic_of(const Arguments& a, Eigen::Isometry3d T_lidar_camera,
                               std::vector<cmap::Warning>& warnings) {
  if (!a.extrinsic.empty()) {
    const Eigen::Matrix4d T = cmap::transform_or_identity(a.extrinsic, warnings);
    T_lidar_camera.matrix() = T;
    T_lidar_camera.linear() = cmap::nearest_rotation(T.topLeftCorner<3, 3>());
  }
  if (!a.turn_deg.empty()) {
    const Eigen::Vector3d turn = Eigen::Vector3d::Map(a.turn_deg.data()) * (std::numbers::pi / 180.0);
    T_lidar_camera.linear() = T_lidar_camera.linear() * cmap::rotation_from(turn);
  }
  if (!a.shift_m.empty()) T_lidar_camera.translation() += Eigen::Vector3d::Map(a.shift_m.data());
  return T_lidar_camera;
}

cmap::PosedImages with_files(cmap::PosedImages images, const cmap::Capture& capture) {
  const std::vector<cmap::PosedImage> list = images.list;
  images.read = [&capture, list](std::size_t place) {
    return cmap::read_image(capture.images[list[place].index].path, capture.calibration.camera);
  };
  return images;
}

/// The points to be colored, without colors of their own.
cmap::PointCloud map_of(const Arguments& a, const cmap::Capture& capture, const cmap::Trajectory& poses,
                        cmap::ColorizeInput& input) {
  if (a.map.empty()) {
    cmap::ScanMapOptions options;
    if (a.voxel_m) options.voxel_m = *a.voxel_m;
    input.voxel_m = options.voxel_m;
    input.scans = cmap::map_of_scans(capture, poses, options);
    return std::move(input.scans->cloud);
  }
  cmap::PointCloud map = cmap::read_point_cloud(a.map).cloud;
  map.colors = {};
  if (!a.voxel_m) return map;
  input.voxel_m = *a.voxel_m;
  return cmap::voxel_thinned(map, *a.voxel_m);
}

/// Unseen points are left out, or have NaN for a color, which only floats can hold.
cmap::PointCloud map_to_write(const Arguments& a, const cmap::Colorization& result) {
  const bool all_seen = result.n_seen == result.cloud.size();
  if (!all_seen && !a.leave_out_unseen) return result.cloud;
  cmap::Array<std::uint8_t> keep(result.cloud.size());
  for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = result.views[i] > 0 ? 1 : 0;
  cmap::PointCloud seen = cmap::select(result.cloud, keep);
  cmap::Array<cmap::Rgb8> colors(seen.size());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const cmap::RgbF c = cmap::rgb_255(seen.colors, i);
    colors[i] = cmap::to_rgb8({c[0], c[1], c[2]});
  }
  seen.colors = std::move(colors);
  return seen;
}

/// Results must not replace what is read: the capture's own files among them.
void refuse_own_inputs(const Arguments& a) {
  cmap::refuse_overwriting({a.map, a.trajectory, a.extrinsic}, a.outputs());
  const std::filesystem::path capture = cmap::place_of_file(a.capture);
  for (const std::string& output : a.outputs()) {
    if (output.empty() || cmap::is_stream(output)) continue;
    const std::filesystem::path within = cmap::place_of_file(output).lexically_relative(capture);
    const std::string first = within.empty() ? ".." : within.begin()->string();
    for (const char* name :
         {"capture.json", "images.csv", "lidar.csv", "lio.tum", "imu.csv", "images", "lidar", "predictions", "truth"}) {
      if (first != name) continue;
      throw cmap::UsageError(fmt::format("{}: lies among the capture's own files; choose another place", output));
    }
  }
}

void check_arguments(const Arguments& a) {
  if (a.capture.empty() || (a.output.empty() && !a.refine)) {
    throw cmap::UsageError("CAPTURE and --output (or --refine-extrinsic) are required");
  }
  if (!a.refined.empty() && !a.refine) throw cmap::UsageError("--extrinsic-output needs --refine-extrinsic");
  if (a.output.empty() && a.leave_out_unseen) throw cmap::UsageError("--leave-out-unseen needs --output");
  refuse_own_inputs(a);
  cmap::check_extension(a.output, {".ply", ".PLY"}, "the colored map is written as PLY");
  for (const std::string& output : a.outputs()) cmap::require_writable(output);
}

cmap::Capture open(const Arguments& a, const std::string& folder) {
  using cmap::Want;
  const Want scans = a.map.empty() ? Want::kYes : Want::kNo;
  return cmap::open_capture(folder,
                            {.images = Want::kYes, .scans = scans, .imu = Want::kIfUsable, .sessions = Want::kNo});
}

cmap::Trajectory poses_of(const Arguments& a, const cmap::Capture& capture, std::vector<cmap::Warning>& warnings) {
  if (a.trajectory.empty()) return capture.lio;
  cmap::TrajectoryFile file = cmap::read_trajectory(a.trajectory);
  warnings.insert(warnings.end(), file.warnings.begin(), file.warnings.end());
  if (!file.has_times) throw cmap::InputError(fmt::format("{}: poses without times", a.trajectory));
  return std::move(file.poses);
}

struct Results {
  cmap::ColorizeInput input;
  std::optional<cmap::RefinedExtrinsic> refined;
  std::optional<cmap::Colorization> colored;
};

nlohmann::ordered_json report_of(const Results& results, const cmap::ColorizeOptions& options,
                                 const std::string& command) {
  nlohmann::ordered_json report =
      results.colored ? cmap::colorize_json(*results.colored, results.input, options, command)
                      : nlohmann::ordered_json{{"schema", "cmap.colorize/1"}, {"run", {{"command", command}}}};
  if (results.refined) report["refined_extrinsic"] = cmap::refined_json(*results.refined);
  return report;
}

/// Prints and writes everything, or writes nothing.
void deliver(const Arguments& a, const Results& results, const cmap::ColorizeOptions& options,
             const std::vector<cmap::Warning>& warnings, const std::string& command) {
  cmap::OutputFiles files;
  files.add(a.output, [&](cmap::OutputFile& file) { cmap::write_ply(file, map_to_write(a, *results.colored)); });
  files.add(a.json, [&](cmap::OutputFile& file) { file.write(report_of(results, options, command).dump(2) + "\n"); });
  files.add(a.refined, [&](cmap::OutputFile& file) {
    file.write(cmap::transform_text(results.refined->T_lidar_camera.matrix()));
  });
  if (!a.common.quiet && !cmap::any_to_standard_output(a.outputs())) {
    std::string text = results.colored ? cmap::colorize_table(*results.colored, results.input) : "";
    if (results.refined) text += cmap::refined_table(*results.refined);
    cmap::print(text);
  }
  if (!a.common.quiet) cmap::print_warnings(warnings);
  files.commit();
}

ExitCode run(const Arguments& a, const std::string& command) {
  cmap::ProgressBar bar(!a.common.quiet);
  const cmap::ExecutionScope scope(
      {.threads = a.common.threads, .progress = [&](std::string_view stage, double done) { bar.update(stage, done); }});
  cmap::ColorizeOptions options = options_of(a);
  if (a.print_options) {
    cmap::print(cmap::options_json(cmap::fields_of(options)).dump(2) + "\n");
    return ExitCode::kDone;
  }
  check_arguments(a);
  const cmap::Capture capture = open(a, cmap::capture_of(a.capture, a.recording, {}));
  std::vector<cmap::Warning> warnings = capture.warnings;
  const cmap::Trajectory poses = poses_of(a, capture, warnings);
  cmap::PosedCapture posed =
      cmap::posed_images(capture, poses, {.subset = subset_of(a), .time_offset_s = a.time_offset_s});
  cmap::PosedImages images = with_files(std::move(posed.images), capture);
  images.T_lidar_camera = extrinsic_of(a, images.T_lidar_camera, warnings);

  Results results;
  results.input.n_chosen = posed.n_chosen;
  results.input.n_without_pose = posed.n_without_pose;
  results.input.T_lidar_camera = images.T_lidar_camera;
  const cmap::PointCloud map = map_of(a, capture, poses, results.input);
  if (a.refine) results.refined = cmap::refine_extrinsic(map, images, options);
  if (!a.output.empty()) results.colored = cmap::colorize(map, images, options);
  deliver(a, results, options, warnings, command);
  return ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  cmap::CommandLine line("cmap_colorize", kDescription, kExample);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(arguments, cmap::shell_command({argv, argv + argc})); });
}
