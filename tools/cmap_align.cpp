// cmap_align SRC DST: the transform that moves one map, or one trajectory, onto another.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cmap/align/align.hpp"
#include "cmap/align/tanks_and_temples.hpp"
#include "cmap/align/trajectory.hpp"
#include "cmap/core/execution.hpp"
#include "files.hpp"
#include "program.hpp"

namespace {

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
    "4 the alignment cannot be determined: no overlap, or a direction that the geometry leaves free; 70 internal "
    "error.";

struct Arguments {
  std::string source, target, method = "gicp", initial, times, output, json, cloud, fit = "sim3";
  double voxel_m = 0.0, max_distance_m = 0.0, tau_m = 0.0, max_gap_s = 0.15;
  bool scale = false, keep_noise = false;
  std::vector<std::uint8_t> classes;
  cmap::CommonArguments common;

  std::vector<std::string> outputs() const { return {output, json, cloud}; }
};

/// The registration methods, and what else aligns.
std::vector<std::string> method_names() {
  std::vector<std::string> names = cmap::registration_names();
  for (const char* other : {"tanksandtemples", "trajectory"}) names.emplace_back(other);
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

void add_options(CLI::App& app, Arguments& a) {
  const auto positive = CLI::Range(1e-9, 1e9).description("");
  app.add_option("SRC", a.source, "map or trajectory to move")->required()->type_name("FILE");
  app.add_option("DST", a.target, "map or trajectory that stays")->required()->type_name("FILE");
  app.add_option("--method", a.method, "one of these [gicp]")->type_name("NAME")->check(cmap::one_of(method_names()));
  app.add_option("-o,--output", a.output, "transform to write: 4x4 as text")->type_name("FILE");
  app.add_option("--output-cloud", a.cloud, "SRC as moved onto DST, to write")->type_name("FILE.ply");
  app.add_option("--json", a.json, "everything about the result, to write")->type_name("FILE");
  app.add_option("--initial", a.initial, "4x4 matrix T_dst_src to start from [identity]")->type_name("FILE");
  app.add_option("--voxel", a.voxel_m, "the source is thinned to this, the target to half [size of DST / 400]")
      ->type_name("M")
      ->check(positive);
  app.add_option("--max-distance", a.max_distance_m, "farther pairs are no matches [10 voxels]")
      ->type_name("M")
      ->check(positive);
  app.add_flag("--scale", a.scale, "estimate the scale too, where the method leaves the choice");
  app.add_option("--tau", a.tau_m, "threshold of tanksandtemples")->type_name("M")->check(positive);
  app.add_option("--fit", a.fit, "of trajectories: first-frame, se3, sim3 [sim3]")
      ->type_name("NAME")
      ->check(cmap::one_of({"first-frame", "se3", "sim3"}));
  app.add_option("--max-gap", a.max_gap_s, "poses farther apart are not interpolated between [0.15]")
      ->type_name("S")
      ->check(positive);
  app.add_option("--times", a.times, "times of poses that have none (KITTI), one number of seconds a line")
      ->type_name("FILE");
  app.add_flag("--keep-noise", a.keep_noise, "LAS: points of the noise classes 7 and 18 count too");
  app.add_option("--classes", a.classes, "LAS: only points of these classes count (2 is ground)")
      ->type_name("N,...")
      ->delimiter(',');
  cmap::add_common_options(app, a.common, "no table and no warnings");
  cmap::refuse_empty(app, {"--output", "--output-cloud", "--json", "--initial", "--times"});
}

/// Whether an option means something for the method; of those that no method of registration is, by name.
bool is_used(std::string_view option, const std::string& method) {
  const bool registers = std::ranges::count(cmap::registration_names(), method) > 0;
  const bool of_tanks = method == "tanksandtemples", of_trajectories = method == "trajectory";
  if (option == "--tau") return of_tanks;
  if (option == "--fit" || option == "--max-gap" || option == "--times") return of_trajectories;
  if (option == "--output-cloud" || option == "--keep-noise" || option == "--classes") return !of_trajectories;
  if (!registers) return option == "--initial" && of_tanks;
  const cmap::RegistrationMethod& how = cmap::registration_method(method);
  if (option == "--initial") return how.needs_initial;
  if (option == "--max-distance") return how.takes_max_distance;
  if (option == "--scale") return how.scale == cmap::ScaleRule::kOnRequest;
  return true;
}

/// Options that the method would ignore are refused: they do not do what their giver thinks.
void refuse_unused(const CLI::App& app, const std::string& method) {
  for (const char* option : {"--initial", "--voxel", "--max-distance", "--scale", "--tau", "--fit", "--max-gap",
                             "--times", "--output-cloud", "--keep-noise", "--classes"}) {
    if (app.get_option(option)->count() == 0 || is_used(option, method)) continue;
    throw cmap::UsageError(fmt::format("{} has no meaning for --method {}", option, method));
  }
}

struct Result {
  cmap::Alignment alignment;
  nlohmann::ordered_json json;
  std::string scores;           ///< further lines of the table
  cmap::PointCloud moved = {};  ///< where it is to be written
};

/// What was said of the inputs comes before what the alignment says.
void add_warnings(const std::vector<cmap::Warning>& of_input, cmap::Alignment& alignment) {
  std::vector<std::string> messages;
  for (const cmap::Warning& warning : of_input) messages.push_back(warning.message);
  alignment.warnings.insert(alignment.warnings.begin(), messages.begin(), messages.end());
}

Result align_trajectories(const Arguments& a) {
  const auto [source, target] = cmap::read_trajectory_pair(a.source, a.target, cmap::path_if_given(a.times));
  Result result;
  try {
    const cmap::TrajectoryFit fit = cmap::trajectory_fit_from_name(a.fit);
    result.alignment = cmap::align_trajectories(source.poses, target.poses, fit, a.max_gap_s);
  } catch (const cmap::UnsupportedError&) {  // what was said of the inputs may be why
    if (!a.common.quiet) cmap::print_warnings(source.warnings), cmap::print_warnings(target.warnings);
    throw;
  }
  add_warnings(target.warnings, result.alignment);
  add_warnings(source.warnings, result.alignment);
  result.json = cmap::alignment_json(result.alignment);
  return result;
}

Result run_tanks_and_temples(const Arguments& a, const cmap::PointCloud& source, const cmap::PointCloud& target,
                             const Eigen::Matrix4d& T_initial, const std::vector<cmap::Warning>& warnings) {
  cmap::TanksAndTemplesOptions options;
  if (!(a.tau_m > 0.0)) throw cmap::UsageError("--method tanksandtemples needs the scene's --tau");
  options.tau_m = a.tau_m;
  cmap::TanksAndTemplesResult found = cmap::tanks_and_temples(source, target, T_initial, options);
  add_warnings(warnings, found.alignment);
  Result result{found.alignment, cmap::alignment_json(found.alignment), {}};
  result.json["tau_m"] = a.tau_m;
  result.json["precision"] = found.precision;
  result.json["recall"] = found.recall;
  result.json["f_score"] = found.f_score;
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
  options.with_scale = a.scale;
  const auto [source, target] = cmap::read_both(a.source, a.target, {.keep_noise = a.keep_noise, .classes = a.classes});
  Result result;
  if (a.method == "tanksandtemples") {
    result = run_tanks_and_temples(a, source.cloud, target.cloud, options.T_initial, warnings);
  } else {
    result.alignment = cmap::align(source.cloud, target.cloud, cmap::registration_method(a.method), options);
    add_warnings(warnings, result.alignment);
    result.json = cmap::alignment_json(result.alignment);
  }
  if (!a.cloud.empty()) result.moved = cmap::transformed(source.cloud, result.alignment.T_dst_src);
  return result;
}

std::string table(const Result& result) {
  const cmap::Alignment& a = result.alignment;
  std::string text = fmt::format("method      {}\nscale       {:.8g}\n", a.method, a.scale);
  text += fmt::format("overlap     {:.4g}   {} of {} points", a.overlap, a.n_matches, a.n_source);
  text += a.max_distance_m > 0.0 ? fmt::format(" within {:.4g} m\n", a.max_distance_m) : "\n";
  text += fmt::format("RMSE        {:.6g} m\n", a.rmse_m);
  if (!a.weakest.empty()) text += fmt::format("condition   {:.3g}   weakest: {}\n", a.condition, a.weakest);
  if (a.iterations > 0)
    text += fmt::format("iterations  {}   {}\n", a.iterations, a.converged ? "converged" : "NOT converged");
  return text + result.scores;
}

/// Prints and writes everything, or writes nothing.
void deliver(const Arguments& a, const Result& result) {
  const std::string matrix = cmap::transform_text(result.alignment.T_dst_src);
  cmap::OutputFiles files;
  files.add(a.output, [&](cmap::OutputFile& file) { file.write(matrix); });
  files.add(a.json, [&](cmap::OutputFile& file) { file.write(result.json.dump(2) + "\n"); });
  files.add(a.cloud, [&](cmap::OutputFile& file) { cmap::write_ply(file, result.moved); });
  if (!a.common.quiet && !cmap::any_to_standard_output(a.outputs())) {
    cmap::print(table(result) + (a.output.empty() ? "T_dst_src\n" + matrix : ""));
  }
  if (!a.common.quiet) {
    for (const std::string& warning : result.alignment.warnings) fmt::print(stderr, "warning: {}\n", warning);
  }
  files.commit();
}

cmap::ExitCode run(const CLI::App& app, const Arguments& a) {
  const cmap::ExecutionScope scope({.threads = a.common.threads});
  refuse_unused(app, a.method);
  cmap::refuse_overwriting({a.source, a.target, a.initial, a.times}, a.outputs());
  for (const std::string& output : a.outputs()) cmap::require_writable(output);
  cmap::check_extension(a.cloud, {".ply", ".PLY"}, "the moved map is written as PLY");
  deliver(a, a.method == "trajectory" ? align_trajectories(a) : align_maps(a));
  return cmap::ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(description(), "cmap_align");
  app.footer(std::string(kExample) + cmap::kDash);
  Arguments arguments;
  add_options(app, arguments);
  return cmap::run_program(app, argc, argv, [&] { return run(app, arguments); });
}
