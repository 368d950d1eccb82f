// cmap_recon CAPTURE -o DIR: sessions of VGGT predictions and LiDAR become one metric colored map.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "cmap/eval/protocol.hpp"
#include "cmap/io/output_folder.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "cmap/recon/capture_check.hpp"
#include "cmap/recon/reconstruction_input.hpp"
#include "cmap/recon/reconstruction_report.hpp"
#include "cmap/report/figure_module.hpp"
#include "cmap/report/report.hpp"
#ifdef CMAP_WITH_RENDER
#include "cmap/render/reconstruction_figure.hpp"
#endif
#include "command_line.hpp"
#include "files.hpp"
#include "own_figure.hpp"
#include "program.hpp"
#include "recording_input.hpp"

namespace {

using cmap::ExitCode;
namespace fs = std::filesystem;

constexpr const char* kDescription =
    "Reconstructs a metric colored map from a capture: VGGT predictions in sessions of unknown scale, LiDAR scans and\n"
    "LiDAR-inertial poses (lio.tum; without one odometry runs first). Pre-fusion by poses, registration of each "
    "session onto the LiDAR (Sim(3) with an expected\n"
    "scale), pose graph, fusion. Writes map.ply, trajectory.tum (world_T_imu), sessions.json and report.json to DIR.\n"
    "A capture of your own: docs/FROM_YOUR_OWN_DATA.md.";

constexpr const char* kExample =
    "Examples:\n"
    "  cmap_simulate small_town -o capture\n"
    "  cmap_recon capture --check\n"
    "  cmap_recon capture -o map --evaluate capture/truth/map.ply\n"
    "\n"
    "--check prints a line for each fault (what ends a run, is left out of it or contradicts another file) and each\n"
    "warning (what a run goes on with), with file, place and reason.\n"
    "\n"
    "Exit codes: 0 done, or --check found no fault; 2 wrong usage or configuration; 3 an input is missing or\n"
    "malformed, or --check found a fault; 4 the capture does not support a map: fewer than half of its sessions can\n"
    "be placed; 70 internal error.";

struct Arguments {
  std::string capture, output, preset = "default", config, reference, figure;
  std::vector<std::string> settings;
  std::optional<cmap::SessionRegistrationMethod> registration;
  cmap::Stage stop_after = cmap::Stage::kFusion;
  std::optional<int> only_session;
  bool check = false, resume = false, session_maps = false, print_options = false;
  cmap::RecordingArguments recording;
  cmap::CommonArguments common;
};

/// The names that the library has for stages.
cmap::EnumNames<cmap::Stage> named_stages() {
  using cmap::Stage;
  cmap::EnumNames<Stage> names;
  for (const Stage stage : {Stage::kPrefusion, Stage::kRegistration, Stage::kPoseGraph, Stage::kFusion}) {
    names.emplace_back(stage, cmap::stage_name(stage));
  }
  return names;
}

void add_options(cmap::CommandLine& line, Arguments& a) {
  const cmap::EnumNames<cmap::SessionRegistrationMethod>& methods = cmap::registration_method_names();
  line.add("CAPTURE", a.capture, "PATH", "folder of a capture, or a recording");
  line.add("-o,--output", a.output, "DIR", "folder for the results; made if need be").not_empty();
  line.add_flag("--check", a.check, "list all that is missing or odd in CAPTURE at once; writes nothing");
  line.add("--evaluate", a.reference, "REF", "reference map: also evaluation.json and evaluation.png").not_empty();
  line.add("--figure", a.figure, "FILE", "the sessions from above after each stage: .png, .jpg, .tif").not_empty();
  line.add_choice("--registration", a.registration,
                  cmap::EnumNames<std::optional<cmap::SessionRegistrationMethod>>(methods.begin(), methods.end()),
                  "NAME", "prefusion (none), normal, paper or robust [robust]");
  line.add_word("--preset", a.preset, {"default", "paper"}, "NAME",
                "default, or paper: the method as printed [default]");
  line.add("--config", a.config, "FILE", "JSON file of options, see --print-options").not_empty();
  line.add("--set", a.settings, "NAME=VALUE", "one option by its name; may be repeated").one_at_a_time().not_empty();
  line.add_flag("--print-options", a.print_options, "all options as JSON, and nothing else");
  line.add_choice("--stop-after", a.stop_after, named_stages(), "STAGE",
                  "prefusion, registration, posegraph or fusion [fusion]");
  line.add("--only-session", a.only_session, "K", "reconstruct this session alone").between(0, 1'000'000);
  line.add_flag("--resume", a.resume, "go on from the stages that an earlier run of the same inputs left in DIR");
  line.add_flag("--session-maps", a.session_maps, "also each session's own map, DIR/sessions/NAME.ply");
  cmap::add_recording_options(line, a.recording);
  cmap::add_common_options(line, a.common, "no table and no progress");
}

cmap::ReconstructionOptions resolve_options(const Arguments& a) {
  cmap::ReconstructionOptions options;
  cmap::apply_reconstruction_preset(options, a.preset);
  if (!a.config.empty()) cmap::apply_reconstruction_config_file(options, a.config);
  for (const std::string& setting : a.settings) cmap::set_reconstruction_option(options, setting);
  if (a.registration) options.registration.method = *a.registration;
  return options;
}

/// The map, as it was written, against a reference in the capture's world: no alignment.
void evaluate_map(const Arguments& a, cmap::PointCloudFile reference, const std::string& command) {
  const fs::path folder(a.output);
  cmap::PointCloudFile map = cmap::read_point_cloud(folder / "map.ply", {.sha256 = true});
  const cmap::InputDescription about_reference = describe(reference), about_map = describe(map);
  const cmap::EvaluatedPair evaluation =
      cmap::evaluate_by_protocol(std::move(reference.cloud), std::move(map.cloud), {});
  cmap::RunDescription run;
  run.command = command;
  const nlohmann::ordered_json report = cmap::make_report(about_reference, about_map, evaluation, run);
  cmap::OutputFiles files;
  files.add(folder / "evaluation.json", [&](cmap::OutputFile& file) { file.write(report.dump(2) + "\n"); });
  files.add(folder / "evaluation.png",
            [&](cmap::OutputFile& file) { cmap::FigureModule().write(evaluation, "evaluation.png", file); });
  if (!a.common.quiet) cmap::print(fmt::format("\n{}", cmap::format_table(report)));
  files.commit();
}

#ifdef CMAP_WITH_RENDER
void write_figure(const cmap::Reconstruction& r, const std::string& name, cmap::OutputFile& file) {
  cmap::write_image(cmap::draw_reconstruction(r), name, file);
}
#else
void write_figure(const cmap::Reconstruction&, const std::string&, cmap::OutputFile&) {}
#endif

void deliver(const Arguments& a, const cmap::Reconstruction& r, const cmap::ReconstructionOptions& options,
             const std::string& command, cmap::OutputFiles& files) {
  const fs::path folder(a.output);
  if (a.stop_after == cmap::Stage::kFusion) {
    files.add(folder / "map.ply", [&](cmap::OutputFile& file) { cmap::write_ply(file, r.map); });
  }
  files.add(folder / "trajectory.tum", [&](cmap::OutputFile& file) { cmap::write_tum_trajectory(r.trajectory, file); });
  files.add(folder / "sessions.json",
            [&](cmap::OutputFile& file) { file.write(cmap::sessions_json(r).dump(2) + "\n"); });
  files.add(folder / "report.json",
            [&](cmap::OutputFile& file) { file.write(cmap::reconstruction_json(r, options, command).dump(2) + "\n"); });
  files.add(a.figure, [&](cmap::OutputFile& file) { write_figure(r, a.figure, file); });
  if (!a.common.quiet) cmap::print(cmap::reconstruction_table(r));
  files.commit();
}

/// Results must not become inputs of the next run, nor replace what lies there. Other folders in the capture's are
/// free.
void refuse_inside_capture(const Arguments& a, const std::string& result) {
  const fs::path place = cmap::place_of_file(result), capture = cmap::place_of_file(a.capture);
  const std::string within = place.lexically_relative(capture).begin()->string();
  for (const char* name : {".", "images", "lidar", "predictions", "truth"}) {
    if (within != name) continue;
    throw cmap::UsageError(fmt::format("{}: lies in the capture that is read; choose another place", result));
  }
}

void refuse_own_inputs(const Arguments& a) {
  refuse_inside_capture(a, a.output);
  std::vector<std::string> outputs;
  for (const char* name :
       {"map.ply", "trajectory.tum", "sessions.json", "report.json", "evaluation.json", "evaluation.png"}) {
    outputs.push_back((fs::path(a.output) / name).string());
  }
  if (!a.figure.empty()) {
    refuse_inside_capture(a, a.figure);
    outputs.push_back(a.figure);
  }
  cmap::refuse_overwriting({a.reference, a.config}, outputs);
}

void check_arguments(const Arguments& a) {
  if (a.capture.empty() || a.output.empty()) throw cmap::UsageError("CAPTURE and --output are required");
  refuse_own_inputs(a);
  for (const auto& [given, option] :
       {std::pair(!a.reference.empty(), "--evaluate"), std::pair(!a.figure.empty(), "--figure"),
        std::pair(a.session_maps, "--session-maps")}) {
    if (given && a.stop_after != cmap::Stage::kFusion) {
      throw cmap::UsageError(fmt::format("{} needs the whole run: not with --stop-after", option));
    }
  }
  cmap::check_figure(a.figure);
}

fs::path session_map_path(const Arguments& a, const std::string& session) {
  return fs::path(a.output) / "sessions" / (session + ".ply");
}

/// For as long as the result lives, no other run writes into the folder.
cmap::FolderLock make_output_folders(const Arguments& a, const cmap::Capture& capture) {
  const fs::path folder(a.output);
  cmap::make_folder(folder);
  cmap::FolderLock lock(folder);
  if (a.session_maps) {
    cmap::make_folder(folder / "sessions");
    for (const fs::path& session : capture.sessions) {
      cmap::require_writable(session_map_path(a, session.filename().string()));
    }
  }
  for (const char* name : {"map.ply", "trajectory.tum", "sessions.json", "report.json"}) {
    cmap::require_writable(folder / name);
  }
  return lock;
}

/// Of an earlier run, of sessions that this one has no map of.
void remove_stale_session_maps(const Arguments& a, const cmap::Capture& capture, const std::vector<fs::path>& written) {
  for (const fs::path& session : capture.sessions) {
    const fs::path path = session_map_path(a, session.filename().string());
    std::error_code ignored;
    if (std::ranges::find(written, path) == written.end()) fs::remove(path, ignored);
  }
}

std::string counted(std::size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); }

ExitCode check(const Arguments& a, const cmap::ReconstructionOptions& options) {
  if (a.capture.empty()) throw cmap::UsageError("CAPTURE is required");
  const cmap::CaptureCheck found = [&] {
    cmap::ProgressBar progress(!a.common.quiet);
    return cmap::check_capture(a.capture, options, a.stop_after, {.progress = [&](std::string_view stage, double done) {
                                 progress.update(stage, done);
                               }});
  }();
  std::string text;
  for (const std::string& fault : found.faults) text += fmt::format("fault: {}\n", fault);
  for (const std::string& warning : found.warnings) text += fmt::format("warning: {}\n", warning);
  if (!a.common.quiet) {
    text += fmt::format("{}, {}{}{}\n", counted(found.faults.size(), "fault"),
                        counted(found.warnings.size(), "warning"), found.summary.empty() ? "" : ": ", found.summary);
  }
  cmap::print(text);
  return found.faults.empty() ? ExitCode::kDone : ExitCode::kInput;
}

/// The poses that the capture did not have, for the next run.
void add_odometry(const Arguments& a, const cmap::LidarMapping& odometry, cmap::OutputFiles& files) {
  const fs::path path = fs::path(a.output) / "lio.tum";
  fmt::print(stderr, "note: {}: no lio.tum; its poses are those of odometry (kept as {})\n", a.capture, path.string());
  if (!a.common.quiet) fmt::print(stderr, "{}", cmap::mapping_table(odometry));
  files.add(path, [&](cmap::OutputFile& file) { cmap::write_tum_trajectory(odometry.imu_stamps, file); });
}

ExitCode run(const Arguments& a, const std::string& command) {
  const cmap::ExecutionScope scope({.threads = a.common.threads});
  const cmap::ReconstructionOptions options = resolve_options(a);
  if (a.print_options) {
    cmap::print(cmap::to_json(options).dump(2) + "\n");
    return ExitCode::kDone;
  }
  if (a.check) return check(a, options);
  check_arguments(a);
  std::optional<cmap::PointCloudFile> reference;
  if (!a.reference.empty()) reference = cmap::read_point_cloud(a.reference, {.sha256 = true});
  cmap::ProgressBar progress(!a.common.quiet);
  const auto tell = [&](std::string_view stage, double done) { progress.update(stage, done); };
  const cmap::ReconstructionInput input = cmap::open_reconstruction_input(
      cmap::capture_of(a.capture, a.recording, {.progress = tell}), options, a.stop_after, {.progress = tell});
  const cmap::Capture& capture = input.capture;
  const cmap::FolderLock lock = make_output_folders(a, capture);
  cmap::OutputFiles files;
  if (input.odometry) add_odometry(a, *input.odometry, files);
  cmap::ReconstructionRun how;
  how.last = a.stop_after;
  if (a.only_session) how.only_session = static_cast<std::size_t>(*a.only_session);
  how.stages = fs::path(a.output) / "stages";
  how.resume = a.resume;
  how.execution.progress = tell;
  std::vector<fs::path> session_maps;
  if (a.session_maps) {
    how.session_map = [&](const std::string& session, const cmap::PointCloud& map) {
      session_maps.push_back(session_map_path(a, session));
      files.add(session_maps.back(), [&](cmap::OutputFile& file) { cmap::write_ply(file, map); });
    };
  }
  const cmap::Reconstruction result = cmap::reconstruct(capture, options, how);
  for (const cmap::Warning& warning : result.warnings) fmt::print(stderr, "warning: {}\n", warning.message);
  deliver(a, result, options, command, files);
  if (a.session_maps) remove_stale_session_maps(a, capture, session_maps);
  if (reference) evaluate_map(a, std::move(*reference), command);
  return ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  cmap::CommandLine line("cmap_recon", kDescription, kExample);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(arguments, cmap::shell_command({argv, argv + argc})); });
}
