// cmap_align SRC DST: the transform that moves one map, or one trajectory, onto another.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "cmap/align/align.hpp"
#include "cmap/align/align_method.hpp"
#include "cmap/align/tanks_and_temples.hpp"
#include "cmap/align/trajectory.hpp"
#include "cmap/align/trajectory_text.hpp"
#include "cmap/align/trust.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/io/number_text.hpp"
#include "cmap/metrics/metric_options.hpp"
#include "cmap/render/alignment_figure.hpp"
#include "cmap/report/figure_module.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "program.hpp"

namespace {

using cmap::AlignKind;

constexpr const char* kDescription =
    "Finds the transform T_dst_src that moves a point-cloud map SRC onto another, DST, in the frame of DST.\n"
    "Methods, from a start near enough (--initial, or the identity) where none is said:\n"
    "{}"
    "  tanksandtemples  that benchmark's refinement and scores\n"
    "  trajectory       SRC and DST are poses (TUM, EuRoC, KITTI, or columns that a header line names), paired by time";

constexpr const char* kExample =
    "Example:\n"
    "  cmap_align data_samples/town/estimate.ply data_samples/town/reference.ply --method gicp --voxel 0.2 -o T.txt\n"
    "\n"
    "Exit codes: 0 done; 2 wrong usage; 3 an input is missing, malformed or without a finite point;\n"
    "4 the alignment cannot be determined: no overlap, a direction that the geometry leaves free, or a verdict other\n"
    "than determined or a little weak, unless --allow-unconverged; 70 internal error.";

struct Arguments {
  std::string source, target, initial, times, time_offset, output, json, cloud, figure;
  cmap::AlignMethod method{AlignKind::kRegistration, &cmap::registration_method("gicp")};
  cmap::TrajectoryOptions trajectories;
  double voxel_m = 0.0, max_distance_m = 0.0, finest_m = 0.0, tau_m = 0.0;
  bool scale = false, keep_noise = false, allow_unconverged = false;
  bool recognized = false;  ///< as trajectories, by what the files hold
  std::vector<std::uint8_t> classes;
  cmap::CommonArguments common;

  std::vector<std::string> outputs() const { return {output, json, cloud, figure}; }
};

/// Those of registration first.
cmap::EnumNames<cmap::AlignMethod> method_names() {
  cmap::EnumNames<cmap::AlignMethod> names;
  for (const auto kind : {AlignKind::kRegistration, AlignKind::kTanksAndTemples, AlignKind::kTrajectory}) {
    for (const auto& named : cmap::align_method_names()) {
      if (named.first.kind == kind) names.push_back(named);
    }
  }
  return names;
}

std::string description() {
  std::string methods;
  for (const cmap::RegistrationMethod* method : cmap::registration_methods()) {
    const bool rigid = method->scale == cmap::ScaleRule::kOnRequest;
    methods += fmt::format("  {:<15}  {}{}\n", method->name, method->summary, rigid ? "; rigid, or with --scale" : "");
  }
  return fmt::format(kDescription, methods);
}

void add_method_options(cmap::CommandLine& line, Arguments& a) {
  constexpr double kLeast = 1e-9, kMost = 1e9;
  line.add("--initial", a.initial, "FILE", "4x4 matrix T_dst_src to start from [identity]").not_empty();
  line.add("--voxel", a.voxel_m, "M", "the source is thinned to this, the target to half [size of DST / 400]")
      .between(kLeast, kMost);
  line.add("--max-distance", a.max_distance_m, "M", "farther pairs are no matches [10 voxels]").between(kLeast, kMost);
  line.add("--finest", a.finest_m, "M",
           "smallest distance to be scored afterwards: without --voxel, levels go on to it, as far as points allow "
           "[none]")
      .between(kLeast, kMost);
  line.add_flag("--scale", a.scale, "estimate the scale too, where the method leaves the choice");
  line.add("--tau", a.tau_m, "M", "threshold of tanksandtemples").between(kLeast, kMost);
  line.add_choice("--fit", a.trajectories.fit, cmap::trajectory_fit_names(), "NAME",
                  "of trajectories: first-frame, se3, sim3 [sim3]");
  line.add_choice("--pairing", a.trajectories.pairing, cmap::time_pairing_names(), "NAME",
                  "DST's poses interpolated to SRC's times, or evo's nearest ones [interpolated]");
  line.add("--max-difference", a.trajectories.max_difference_s, "S", "nearest poses farther apart are no pair [0.01]")
      .between(kLeast, kMost);
  line.add("--time-offset", a.time_offset, "S|estimate",
           "added to SRC's times; estimate: found by speed and turns, and refused where they do not tell it [0]")
      .not_empty();
  line.add("--max-gap", a.trajectories.max_gap_s, "S", "poses farther apart are not interpolated between [0.15]")
      .between(kLeast, kMost);
  line.add("--times", a.times, "FILE", "times of poses that have none (KITTI), one number of seconds a line")
      .not_empty();
}

void add_options(cmap::CommandLine& line, Arguments& a) {
  line.add("SRC", a.source, "FILE", "map or trajectory to move").required();
  line.add("DST", a.target, "FILE", "map or trajectory that stays").required();
  line.add_choice("--method", a.method, method_names(), "NAME",
                  "one of these [gicp; of two files of poses: trajectory]");
  line.add("-o,--output", a.output, "FILE", "transform to write: 4x4 as text").not_empty();
  line.add("--output-cloud", a.cloud, "FILE.ply", "SRC as moved onto DST, to write").not_empty();
  line.add("--figure", a.figure, "FILE",
           "picture to write: both maps before and after, distances, the second-best answer: .png, .jpg, .tif")
      .not_empty();
  line.add("--json", a.json, "FILE", "everything about the result, to write").not_empty();
  add_method_options(line, a);
  line.add_flag("--allow-unconverged", a.allow_unconverged,
                "write also what is not to be trusted, with a warning; else it ends with exit code 4");
  line.add_flag("--keep-noise", a.keep_noise, "LAS: points of the noise classes 7 and 18 count too");
  line.add("--classes", a.classes, "N,...", "LAS: only points of these classes count (2 is ground)").with_commas();
  cmap::add_common_options(line, a.common, "no table and no warnings");
}

constexpr std::array<std::string_view, 6> kOfTrajectories{"--fit",         "--pairing", "--max-difference",
                                                          "--time-offset", "--max-gap", "--times"};

bool is_of_trajectories(std::string_view option) {
  return std::ranges::find(kOfTrajectories, option) != kOfTrajectories.end();
}

/// Whether an option means something for the method; of those that not every method takes, by name.
bool is_used(std::string_view option, const cmap::AlignMethod& method) {
  const bool of_tanks = method.kind == AlignKind::kTanksAndTemples;
  const bool of_trajectories = method.kind == AlignKind::kTrajectory;
  if (option == "--tau") return of_tanks;
  if (is_of_trajectories(option)) return of_trajectories;
  if (option == "--output-cloud" || option == "--figure" || option == "--keep-noise" || option == "--classes")
    return !of_trajectories;
  if (option == "--initial") return needs_initial(method);
  if (method.kind != AlignKind::kRegistration) return false;
  if (option == "--max-distance") return method.registration->takes_max_distance;
  if (option == "--scale") return method.registration->scale == cmap::ScaleRule::kOnRequest;
  return true;
}

/// Options that the method would ignore are refused: they do not do what their giver thinks.
void refuse_unused(const cmap::CommandLine& line, const cmap::AlignMethod& method) {
  for (const char* option : {"--initial", "--voxel", "--max-distance", "--finest", "--scale", "--tau", "--fit",
                             "--pairing", "--max-difference", "--time-offset", "--max-gap", "--times", "--output-cloud",
                             "--figure", "--keep-noise", "--classes"}) {
    if (!line.has(option) || is_used(option, method)) continue;
    throw cmap::UsageError(
        fmt::format("{} has no meaning for --method {}", option, name_of(method, cmap::align_method_names())));
  }
  if (line.has("--voxel") && line.has("--finest")) {
    throw cmap::UsageError("--finest has no meaning beside --voxel, which says where levels end");
  }
}

/// The maps, where something is to be written of them.
struct Maps {
  cmap::PointCloud source, target;
  Eigen::Matrix4d T_initial;
};

struct Result {
  cmap::Alignment alignment;
  nlohmann::ordered_json further = nlohmann::ordered_json::object();  ///< beside the alignment's own
  std::string scores;                                                 ///< further lines of the table
  std::optional<Maps> maps = {};
};

/// What was said of the inputs comes before what the alignment says.
void add_warnings(const std::vector<cmap::Warning>& of_input, cmap::Alignment& alignment) {
  std::vector<std::string> messages;
  for (const cmap::Warning& warning : of_input) messages.push_back(warning.message);
  alignment.warnings.insert(alignment.warnings.begin(), messages.begin(), messages.end());
}

cmap::TrajectoryOptions trajectory_options(const Arguments& a) {
  cmap::TrajectoryOptions options = a.trajectories;
  options.find_time_offset = a.time_offset == "estimate";
  if (a.time_offset.empty() || options.find_time_offset) return options;
  if (!cmap::parse_number(a.time_offset, options.time_offset_s) || !std::isfinite(options.time_offset_s)) {
    throw cmap::UsageError(fmt::format("--time-offset: {} is neither a number of seconds nor estimate", a.time_offset));
  }
  return options;
}

Result align_trajectories(const Arguments& a) {
  const auto [source, target] = cmap::read_trajectory_pair(a.source, a.target, cmap::path_if_given(a.times));
  cmap::TrajectoryAlignment found;
  try {
    found = cmap::align_trajectories(with_repeated(source), with_repeated(target), trajectory_options(a));
  } catch (const cmap::UnsupportedError&) {  // what was said of the inputs may be why
    if (!a.common.quiet) cmap::print_warnings(source.warnings), cmap::print_warnings(target.warnings);
    throw;
  }
  add_warnings(target.warnings, found);
  add_warnings(source.warnings, found);
  if (a.recognized) {
    found.warnings.insert(found.warnings.begin(),
                          "both files hold poses: they are aligned as --method trajectory does");
  }
  return {found, trajectory_json(found), trajectory_lines(found)};
}

Result run_tanks_and_temples(const Arguments& a, const cmap::PointCloud& source, const cmap::PointCloud& target,
                             const Eigen::Matrix4d& T_initial, const std::vector<cmap::Warning>& warnings) {
  cmap::TanksAndTemplesOptions options;
  if (!(a.tau_m > 0.0)) throw cmap::UsageError("--method tanksandtemples needs the scene's --tau");
  options.tau_m = a.tau_m;
  cmap::TanksAndTemplesResult found = cmap::tanks_and_temples(source, target, T_initial, options);
  add_warnings(warnings, found.alignment);
  Result result{found.alignment, {}, {}};
  result.further = {
      {"tau_m", a.tau_m}, {"precision", found.precision}, {"recall", found.recall}, {"f_score", found.f_score}};
  result.scores = fmt::format("precision   {:.6g}\nrecall      {:.6g}\nF           {:.6g}   at tau {:g} m\n",
                              found.precision, found.recall, found.f_score, a.tau_m);
  return result;
}

Result align_maps(const Arguments& a) {
  cmap::AlignOptions options;
  std::vector<cmap::Warning> warnings;
  options.T_initial = cmap::transform_or_identity(a.initial, warnings);
  if (a.voxel_m > 0.0) options.voxel_m = a.voxel_m;
  if (a.max_distance_m > 0.0) options.max_distance_m = a.max_distance_m;
  if (a.finest_m > 0.0) options.finest_m = a.finest_m;
  options.with_scale = a.scale;
  auto [source, target] = cmap::read_both(a.source, a.target, {.keep_noise = a.keep_noise, .classes = a.classes});
  Result result;
  if (a.method.kind == AlignKind::kTanksAndTemples) {
    result = run_tanks_and_temples(a, source.cloud, target.cloud, options.T_initial, warnings);
  } else {
    result.alignment = cmap::align(source.cloud, target.cloud, *a.method.registration, options);
    add_warnings(warnings, result.alignment);
  }
  if (!a.cloud.empty() || !a.figure.empty()) {
    result.maps = Maps{std::move(source.cloud), std::move(target.cloud), options.T_initial};
  }
  return result;
}

std::string table(const Result& result) {
  const cmap::Alignment& a = result.alignment;
  std::string text = fmt::format("method      {}\n", a.method) + verdict_lines(a);
  text += fmt::format("scale       {:.8g}\n", a.scale);
  text += fmt::format("overlap     {:.4g}   {} of {} points", a.overlap, a.n_matches, a.n_source);
  text += a.max_distance_m > 0.0 ? fmt::format(" within {:.4g} m\n", a.max_distance_m) : "\n";
  text += fmt::format("RMSE        {:.6g} m\n", a.rmse_m);
  if (!a.weakest.empty()) text += fmt::format("condition   {:.3g}   weakest: {}\n", a.condition, a.weakest);
  if (a.iterations > 0)
    text += fmt::format("iterations  {}   {}\n", a.iterations, a.converged ? "converged" : "NOT converged");
  return text + result.scores;
}

std::string json_text(const Result& result) {
  nlohmann::ordered_json json = cmap::alignment_json(result.alignment);
  json.update(result.further);
  return json.dump(2) + "\n";
}

void print_warnings(const Arguments& a, const cmap::Alignment& alignment) {
  if (a.common.quiet) return;
  for (const std::string& warning : alignment.warnings) fmt::print(stderr, "warning: {}\n", warning);
}

/// Ends with the reason where the result is not to be trusted. What is weaker than the largest threshold of a plain
/// evaluation would decide its scores.
void require_trust(const Arguments& a, cmap::Alignment& alignment) {
  const std::vector<double> thresholds_m = cmap::MetricOptions().thresholds_m;
  try {
    cmap::require_trust(alignment, {.allow_unconverged = a.allow_unconverged,
                                    .largest_error_m = *std::ranges::max_element(thresholds_m)});
  } catch (const cmap::UnsupportedError&) {
    print_warnings(a, alignment);
    throw;
  }
}

/// Prints and writes everything, or writes nothing.
void deliver(const Arguments& a, const Result& result, const std::optional<cmap::FigureModule>& figures) {
  const std::string matrix = cmap::transform_text(result.alignment.T_dst_src);
  cmap::OutputFiles files;
  files.add(a.output, [&](cmap::OutputFile& file) { file.write(matrix); });
  files.add(a.json, [&](cmap::OutputFile& file) { file.write(json_text(result)); });
  files.add(a.cloud, [&](cmap::OutputFile& file) {
    cmap::write_ply(file, cmap::transformed(result.maps->source, result.alignment.T_dst_src));
  });
  files.add(a.figure, [&](cmap::OutputFile& file) {
    const auto& [source, target, T_initial] = *result.maps;
    figures->write(cmap::AlignmentPicture{source, target, T_initial, result.alignment}, a.figure, file);
  });
  if (!a.common.quiet && !cmap::any_to_standard_output(a.outputs())) {
    cmap::print(table(result) + (a.output.empty() ? "T_dst_src\n" + matrix : ""));
  }
  print_warnings(a, result.alignment);
  files.commit();
}

/// Files of poses are no clouds: where no method is said, they are aligned as what they are.
void recognize_trajectories(const cmap::CommandLine& line, Arguments& a) {
  if (line.has("--method") || !cmap::holds_poses(a.source) || !cmap::holds_poses(a.target)) return;
  a.method = {AlignKind::kTrajectory};
  a.recognized = true;
}

cmap::ExitCode run(const cmap::CommandLine& line, Arguments& a) {
  const cmap::ExecutionScope scope({.threads = a.common.threads});
  recognize_trajectories(line, a);
  refuse_unused(line, a.method);
  cmap::refuse_overwriting({a.source, a.target, a.initial, a.times}, a.outputs());
  for (const std::string& output : a.outputs()) cmap::require_writable(output);
  cmap::check_extension(a.cloud, {".ply", ".PLY"}, "the moved map is written as PLY");
  std::optional<cmap::FigureModule> figures;
  if (!a.figure.empty()) figures.emplace().check_name(a.figure);
  Result result = a.method.kind == AlignKind::kTrajectory ? align_trajectories(a) : align_maps(a);
  require_trust(a, result.alignment);
  deliver(a, result, figures);
  return cmap::ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  cmap::CommandLine line("cmap_align", description(), std::string(kExample) + cmap::kDash);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(line, arguments); });
}
