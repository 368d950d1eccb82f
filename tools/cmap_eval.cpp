// cmap_eval REF EST: every metric of one pair of maps; cmap_eval MAP: of one map alone.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "cmap/align/trajectory.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/eval/configuration.hpp"
#include "cmap/eval/map_error.hpp"
#include "cmap/eval/map_evaluation.hpp"
#include "cmap/eval/point_errors.hpp"
#include "cmap/eval/protocol.hpp"
#include "cmap/eval/requirement.hpp"
#include "cmap/eval/shift_warning.hpp"
#include "cmap/io/output_file.hpp"
#include "cmap/report/figure_module.hpp"
#include "cmap/report/html_report.hpp"
#include "cmap/report/report.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "program.hpp"
#include "run_clock.hpp"

namespace {

using cmap::ExitCode;

constexpr const char* kDescription =
    "Evaluates an estimated point-cloud map against a reference: color, geometry and distribution metrics. Of one map\n"
    "alone, what needs no reference: color consistency, mean map entropy, point spacing.\n"
    "Reads ";

constexpr const char* kExample =
    "Examples:\n"
    "  cmap_eval data_samples/town/reference.ply data_samples/town/estimate.ply -o report.json --require 'LCR>=20%'\n"
    "  cmap_eval data_samples/town/estimate.ply -o map.json --html map.html --require 'point_spacing<=0.3'\n"
    "  cmap_eval data_samples/town/reference.ply data_samples/town/estimate.ply --levels\n"
    "\n"
    "Exit codes: 0 done; 1 a --require did not hold; 2 wrong usage or configuration; 3 an input is missing, malformed\n"
    "or without a finite point; 4 the inputs do not support what was asked; 70 internal error.";

enum class Format { kTable, kJson };

/// The command line as given; of one map, `estimate` is empty.
struct Arguments {
  std::string reference, estimate;
  std::string output, html, figure, config, preset, transform, initial;
  Format format = Format::kTable;
  bool levels = false;
  std::string reference_trajectory, estimate_trajectory, times, sensor;
  std::string estimate_errors, reference_errors;
  std::vector<std::string> requirements;
  cmap::OptionTexts metrics;
  cmap::CommonArguments common;

  std::vector<std::string> outputs() const { return {output, html, figure, estimate_errors, reference_errors}; }
};

void add_file_options(cmap::CommandLine& line, Arguments& a) {
  line.add("REF", a.reference, "FILE", "reference map; without EST, the map to evaluate by itself; - is standard input")
      .required()
      .not_empty();
  line.add("EST", a.estimate, "FILE", "estimated map").not_empty();
  line.add("-o,--output", a.output, "FILE", "write the JSON report here; - is standard output, then without the table")
      .not_empty();
  line.add("--html", a.html, "FILE.html", "page with everything: tables, curves, both maps in 3-D; implies --lcr-curve")
      .not_empty();
  line.add("--figure", a.figure, "FILE",
           "picture of both maps, local color recall and color distance: .png, .jpg, .tif")
      .not_empty();
  line.add_choice("--format", a.format, {{Format::kTable, "table"}, {Format::kJson, "json"}}, "FORMAT",
                  "what to print: table or json [table]");
  line.add_flag("--levels", a.levels,
                "floor, chance and skill beside each value of the table; a wide terminal shows them anyway");
  line.add("--config", a.config, "FILE", "JSON file of the options under Metrics; the command line wins").not_empty();
  line.add("--preset", a.preset, "NAME", "shipped configuration: paper, indoor, outdoor, aerial, mapeval").not_empty();
}

void add_alignment_options(cmap::CommandLine& line, Arguments& a) {
  line.add("--transform", a.transform, "FILE", "4x4 matrix T_ref_est that moves the estimate into the reference frame")
      .not_empty();
  line.add("--initial", a.initial, "FILE", "the same as the place where --align begins").not_empty();
  line.add("--ref-trajectory", a.reference_trajectory, "FILE",
           "the reference's poses (TUM, EuRoC, KITTI, or named columns), for --align trajectory")
      .not_empty();
  line.add("--est-trajectory", a.estimate_trajectory, "FILE", "the estimate's poses, at the same times").not_empty();
  line.add("--times", a.times, "FILE", "times of poses that have none (KITTI), one number of seconds a line")
      .not_empty();
  line.add("--observed-from", a.sensor, "FILE|DIR",
           "where the estimate's sensor was: poses, or a capture with its scans and lio.tum, in the estimate's "
           "frame; means --observed sensor")
      .not_empty();
}

void add_options(cmap::CommandLine& line, Arguments& a) {
  add_file_options(line, a);
  add_alignment_options(line, a);
  line.add("--require", a.requirements, "EXPR", "exit 1 unless it holds: LCR>=20%, accuracy@0.1<=0.06; repeatable")
      .repeatable();
  line.add("--export-errors", a.estimate_errors, "FILE.ply", "PLY of the estimate with its distance and color errors")
      .not_empty();
  line.add("--export-reference-errors", a.reference_errors, "FILE.ply", "the same for the reference, with LCR hits")
      .not_empty();
  cmap::add_common_options(line, a.common, "no table, no progress");
  cmap::EvaluationOptions defaults;
  for (const cmap::OptionField& field : option_fields(defaults)) line.add_option(field, a.metrics);
}

cmap::EvaluationOptions resolve_options(const Arguments& arguments) {
  cmap::EvaluationOptions options;
  if (!arguments.preset.empty()) cmap::apply_preset(options, arguments.preset);
  if (!arguments.config.empty()) cmap::apply_config_file(options, arguments.config);
  cmap::set_given(option_fields(options), arguments.metrics);
  return options;
}

cmap::EvaluationOptions pair_options(const Arguments& arguments) {
  cmap::EvaluationOptions options = resolve_options(arguments);
  if (!arguments.html.empty()) options.lcr_curve = true;
  if (!arguments.sensor.empty()) options.observed = cmap::Observed::kSensor;
  if (arguments.sensor.empty() && options.observed == cmap::Observed::kSensor) {
    throw cmap::UsageError("--observed sensor needs --observed-from");
  }
  return options;
}

/// Files that only two maps have a use for.
void refuse_files_of_pairs(const Arguments& a) {
  const std::pair<const char*, const std::string*> files[] = {{"--transform", &a.transform},
                                                              {"--initial", &a.initial},
                                                              {"--ref-trajectory", &a.reference_trajectory},
                                                              {"--est-trajectory", &a.estimate_trajectory},
                                                              {"--times", &a.times},
                                                              {"--observed-from", &a.sensor},
                                                              {"--figure", &a.figure},
                                                              {"--export-errors", &a.estimate_errors},
                                                              {"--export-reference-errors", &a.reference_errors}};
  for (const auto& [option, file] : files) {
    if (file->empty()) continue;
    const char* way_out = file == &a.figure ? "; cmap_render MAP -o FILE draws one map" : "";
    throw cmap::UsageError(
        fmt::format("{} needs two maps, a reference and an estimate; here is only {}{}", option, a.reference, way_out));
  }
}

void append(const std::vector<cmap::Warning>& more, std::vector<cmap::Warning>& warnings) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

constexpr cmap::CaptureParts kWhereTheScannerWas{
    .images = cmap::Want::kNo, .imu = cmap::Want::kNo, .sessions = cmap::Want::kNo};

/// The poses of a file, or where the scanner of a capture was.
std::vector<Eigen::Vector3d> sensor_positions(const std::string& path, std::vector<cmap::Warning>& warnings) {
  if (std::filesystem::is_directory(path)) {
    const cmap::Capture capture = cmap::open_capture(path, kWhereTheScannerWas);
    append(capture.warnings, warnings);
    return cmap::scanner_positions(capture);
  }
  const cmap::TrajectoryFile file = cmap::read_trajectory(path);
  append(file.warnings, warnings);
  std::vector<Eigen::Vector3d> positions;
  for (const cmap::StampedPose& pose : file.poses) positions.push_back(pose.position);
  return positions;
}

void read_trajectories(const Arguments& a, cmap::ProtocolInputs& inputs) {
  const auto [reference, estimate] =
      cmap::read_trajectory_pair(a.reference_trajectory, a.estimate_trajectory, cmap::path_if_given(a.times));
  append(reference.warnings, inputs.warnings);
  append(estimate.warnings, inputs.warnings);
  inputs.reference_trajectory = with_repeated(reference);
  inputs.estimate_trajectory = with_repeated(estimate);
}

/// Files that only another option would read are mistakes.
cmap::ProtocolInputs protocol_inputs(const Arguments& a, const cmap::EvaluationOptions& options) {
  const bool by_trajectories = options.align.kind == cmap::AlignKind::kTrajectory;
  if (!a.initial.empty() && (!needs_initial(options.align) || !a.transform.empty())) {
    throw cmap::UsageError("--initial needs an --align that begins somewhere, and no --transform");
  }
  if (by_trajectories == (a.reference_trajectory.empty() || a.estimate_trajectory.empty()) ||
      (!by_trajectories && !(a.reference_trajectory.empty() && a.estimate_trajectory.empty()))) {
    throw cmap::UsageError("--align trajectory needs --ref-trajectory and --est-trajectory, and they need it");
  }
  if (!by_trajectories && !a.times.empty()) throw cmap::UsageError("--times needs --align trajectory");
  cmap::ProtocolInputs inputs;
  inputs.T_initial = cmap::transform_or_identity(a.initial.empty() ? a.transform : a.initial, inputs.warnings);
  if (by_trajectories) read_trajectories(a, inputs);
  if (!a.sensor.empty()) inputs.sensor_positions = sensor_positions(a.sensor, inputs.warnings);
  return inputs;
}

/// What is wrong with the points of a map is said of its file.
template <class Evaluate>
auto blaming_files(const Arguments& arguments, Evaluate&& evaluate) {
  try {
    return evaluate();
  } catch (const cmap::MapError& error) {
    const std::string& file = error.which == "estimate" ? arguments.estimate : arguments.reference;
    throw cmap::InputError(fmt::format("{}: {}", file, error.reason));
  }
}

template <class Evaluated>
bool check_requirements(const std::vector<cmap::Requirement>& requirements, const Evaluated& evaluation) {
  bool all_hold = true;
  for (const cmap::Requirement& requirement : requirements) {
    const cmap::RequirementOutcome outcome = cmap::check(requirement, evaluation);
    if (outcome.holds) continue;
    all_hold = false;
    const std::string found = outcome.value ? fmt::format("{}", *outcome.value) : "no value";
    fmt::print(stderr, "cmap_eval: requirement not met: {} (found {})\n", requirement.text, found);
  }
  return all_hold;
}

/// Outputs that cannot be written, or not in their format, are refused before the work.
void check_outputs(const Arguments& a) {
  for (const std::string& output : a.outputs()) cmap::require_writable(output);
  cmap::check_extension(a.html, {".html", ".htm", ".HTML", ".HTM"}, "the page is HTML");
  for (const std::string& ply : {a.estimate_errors, a.reference_errors}) {
    cmap::check_extension(ply, {".ply", ".PLY"}, "point errors are written as PLY");
  }
}

/// Levels where they are asked for, and where the terminal has room for them.
cmap::TableLayout table_layout(const Arguments& arguments) {
  const std::size_t width = cmap::terminal_width();
  return {.levels = arguments.levels || width >= cmap::kWidthForLevels, .width = width};
}

/// Prints and writes everything: all outputs or none, and none before the last one is complete.
template <class Evaluated>
void deliver(const Arguments& arguments, const Evaluated& evaluation, const nlohmann::ordered_json& report,
             cmap::OutputFiles files) {
  const std::string report_text = report.dump(2) + "\n";
  files.add(arguments.html, [&](cmap::OutputFile& file) { cmap::write_html_report(report, evaluation, file); });
  files.add(arguments.output, [&](cmap::OutputFile& file) { file.write(report_text); });
  if (!arguments.common.quiet && !cmap::any_to_standard_output(arguments.outputs())) {
    cmap::print(arguments.format == Format::kJson ? report_text : cmap::format_table(report, table_layout(arguments)));
  }
  files.commit();
}

ExitCode exit_code(bool requirements_hold) {
  return requirements_hold ? ExitCode::kDone : ExitCode::kRequirementFailed;
}

ExitCode run_pair(const Arguments& arguments, cmap::RunClock& clock) {
  std::optional<cmap::FigureModule> figures;
  if (!arguments.figure.empty()) figures.emplace().check_name(arguments.figure);
  const cmap::EvaluationOptions options = pair_options(arguments);
  std::vector<cmap::Requirement> requirements;
  for (const std::string& text : arguments.requirements) requirements.push_back(cmap::parse_requirement(text, options));
  const cmap::ProtocolInputs inputs = protocol_inputs(arguments, options);

  auto [reference, estimate] = clock.timed_reading(
      [&] { return cmap::read_both(arguments.reference, arguments.estimate, cmap::read_options(options, true)); });
  const cmap::InputDescription about_reference = describe(reference), about_estimate = describe(estimate);
  cmap::EvaluatedPair evaluation = blaming_files(arguments, [&] {
    return cmap::evaluate_by_protocol(std::move(reference.cloud), std::move(estimate.cloud), options, inputs,
                                      {.progress = clock.progress()});
  });
  cmap::warn_about_shifts(evaluation, arguments.reference, arguments.estimate);
  const auto report =
      cmap::make_report(about_reference, about_estimate, evaluation, clock.description_after(evaluation));
  const bool requirements_hold = check_requirements(requirements, evaluation);

  cmap::OutputFiles files;
  files.add(arguments.estimate_errors, [&](cmap::OutputFile& file) { cmap::write_estimate_errors(evaluation, file); });
  files.add(arguments.reference_errors,
            [&](cmap::OutputFile& file) { cmap::write_reference_errors(evaluation, file); });
  files.add(arguments.figure, [&](cmap::OutputFile& file) { figures->write(evaluation, arguments.figure, file); });
  deliver(arguments, evaluation, report, std::move(files));
  return exit_code(requirements_hold);
}

ExitCode run_map(const Arguments& arguments, cmap::RunClock& clock) {
  refuse_files_of_pairs(arguments);
  const cmap::EvaluationOptions options = resolve_options(arguments);
  cmap::select_map_metrics(options);  // refuses before the work
  std::vector<cmap::Requirement> requirements;
  for (const std::string& text : arguments.requirements) {
    requirements.push_back(cmap::parse_map_requirement(text, options));
  }
  cmap::PointCloudFile map = clock.timed_reading(
      [&] { return cmap::read_point_cloud(arguments.reference, cmap::read_options(options, true)); });
  const cmap::InputDescription about_map = describe(map);
  const cmap::EvaluatedMap evaluation = blaming_files(
      arguments, [&] { return cmap::evaluate_map(std::move(map.cloud), options, {.progress = clock.progress()}); });
  const auto report = cmap::make_report(about_map, evaluation, clock.description_after(evaluation));
  const bool requirements_hold = check_requirements(requirements, evaluation);
  deliver(arguments, evaluation, report, {});
  return exit_code(requirements_hold);
}

ExitCode run(const Arguments& arguments, const std::string& command) {
  const cmap::ExecutionScope scope({.threads = arguments.common.threads});
  cmap::RunClock clock(command, arguments.common.quiet);
  cmap::refuse_overwriting(
      {arguments.reference, arguments.estimate, arguments.config, arguments.transform, arguments.initial,
       arguments.reference_trajectory, arguments.estimate_trajectory, arguments.times, arguments.sensor},
      arguments.outputs());
  check_outputs(arguments);
  return arguments.estimate.empty() ? run_map(arguments, clock) : run_pair(arguments, clock);
}

}  // namespace

int main(int argc, char** argv) {
  cmap::CommandLine line("cmap_eval", std::string(kDescription) + cmap::readable_formats() + ".",
                         std::string(kExample) + cmap::kDash);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(arguments, cmap::shell_command({argv, argv + argc})); });
}
