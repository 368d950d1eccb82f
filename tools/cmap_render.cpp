// cmap_render MAP [EST]: off-screen pictures of a map, or of what is wrong with one.

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <sstream>
#include <variant>

#include "cmap/core/execution.hpp"
#include "cmap/core/progress.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/render/figure.hpp"
#include "cmap/render/gl_module.hpp"
#include "cmap/render/point_text.hpp"
#include "cmap/render/standard_figure.hpp"
#include "cmap/render/turntable.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "program.hpp"

namespace {

constexpr const char* kDescription =
    "Draws a point-cloud map, or an estimated map beside its reference with what is wrong with it.\n"
    "Needs no display and no GPU; --interactive opens a window in which h shows the keys.\n"
    "Layers: reference, estimate, lcr, color-distance, distance, delta-e, ccs, color-wasserstein, wasserstein, "
    "density, height.";

constexpr const char* kExample =
    "Example:\n"
    "  cmap_render data_samples/town/reference.ply data_samples/town/estimate.ply -o figure.png\n"
    "\n"
    "A camera file is JSON: {\"position_m\": [x, y, z], \"target_m\": [x, y, z], \"up\": [0, 0, 1],\n"
    "\"field_of_view_deg\": 35}, or \"view_height_m\" for a parallel projection; or a view that Open3D saved\n"
    "(ViewTrajectory, PinholeCameraParameters).\n"
    "\n"
    "Exit codes: 0 done; 2 wrong usage; 3 an input is missing, malformed or without a finite point;\n"
    "4 the inputs do not have what a layer needs; 70 internal error.";

struct Arguments {
  std::string map, estimate, output, turntable, transform;
  std::string camera = "oblique", size = "1600x1000", background = "white", color_map, renderer = "splat";
  std::vector<std::string> panels;
  std::vector<double> range;
  double point_size = 1.0;
  int frames = 120;
  bool orthographic = false, logarithmic = false, interactive = false;
  cmap::OptionTexts metrics;
  cmap::CommonArguments common;
};

/// Whether a picture depends on an option of the evaluation.
bool is_drawn(std::string_view option) {
  if (option == "keep-noise" || option == "classes") return true;
  if (option == "lcr-curve" || option == "ccs-phases") return false;
  constexpr std::string_view kOfLayers[]{"lcr-", "ccs-", "cw-", "awd-"};
  return std::ranges::any_of(kOfLayers, [&](std::string_view start) { return option.starts_with(start); });
}

void add_drawing_options(cmap::CommandLine& line, Arguments& a) {
  line.add("--panels", a.panels, "LIST", "layers side by side [reference,estimate,lcr,color-distance]")
      .with_commas()
      .values(1, 9);
  line.add("--camera", a.camera, "VIEW",
           "top, oblique, front, side, fit, or a file: ours or one of Open3D, see below [oblique]")
      .not_empty();
  line.add_flag("--orthographic", a.orthographic, "parallel projection");
  line.add("--size", a.size, "WxH", "of the picture in pixels [1600x1000]");
  line.add("--range", a.range, "LOW,HIGH", "ends of the color scale of heat maps, for pictures that are to be compared")
      .with_commas()
      .values(2, 2)
      .shown_as("LOW,HIGH");
  line.add_flag("--log", a.logarithmic, "logarithmic color scale");
  line.add("--color-map", a.color_map, "NAME", "viridis, cividis, inferno or turbo").not_empty();
  line.add("--background", a.background, "NAME", "white, black or transparent [white]");
  line.add("--point-size", a.point_size, "FACTOR", "factor on the size of points [1]").between(0.01, 100.0);
  line.add("--renderer", a.renderer, "NAME", "splat, on the processor, or gl, by OpenGL: the same picture [splat]")
      .not_empty();
}

void add_options(cmap::CommandLine& line, Arguments& a) {
  line.add("MAP", a.map, "FILE", "map to draw; with EST, the reference").required();
  line.add("EST", a.estimate, "FILE", "estimated map");
  line.add("-o,--output", a.output, "FILE", "picture to write: .png, .jpg or .tif").not_empty();
  line.add_flag("--interactive", a.interactive, "a window to turn, zoom and pick points in; needs an X display");
  add_drawing_options(line, a);
  line.add("--transform", a.transform, "FILE", "4x4 matrix T_ref_est that moves the estimate into the reference frame")
      .not_empty();
  line.add("--turntable", a.turntable, "NAME", "full turn around the map: .mp4, .gif, or a new folder of frames")
      .not_empty();
  line.add("--frames", a.frames, "N", "of the turn, 24 a second [120]").between(2, 10000);
  cmap::add_common_options(line, a.common, "no progress, and not which device OpenGL draws by");
  cmap::EvaluationOptions defaults;
  for (const cmap::OptionField& field : option_fields(defaults)) {
    if (is_drawn(field.name)) line.add_option(field, a.metrics);
  }
}

cmap::FigureOptions figure_options(const Arguments& a) {
  cmap::FigureOptions options;
  char x = 0;
  std::istringstream size(a.size);
  if (!(size >> options.width_px >> x >> options.height_px) || x != 'x' || !size.eof()) {
    throw cmap::UsageError(fmt::format("--size: \"{}\" is not WIDTHxHEIGHT", a.size));
  }
  options.background = cmap::background_from_name(a.background);
  options.point_size = a.point_size;
  if (a.renderer == "gl") {
    std::string device;
    options.splatter = cmap::GlModule().open_splatter(device);
    if (!a.common.quiet) fmt::print(stderr, "cmap_render: draws by {}\n", device);
  } else if (a.renderer != "splat") {
    throw cmap::UsageError(fmt::format("--renderer: \"{}\" is none of splat, gl", a.renderer));
  }
  return options;
}

cmap::LayerOptions layer_options(const Arguments& a) {
  cmap::LayerOptions options;
  options.logarithmic = a.logarithmic;
  if (!a.color_map.empty()) options.color_map = cmap::color_map_from_name(a.color_map);
  if (!a.range.empty()) {
    if (!(a.range[0] < a.range[1])) throw cmap::UsageError("--range: LOW must be below HIGH");
    if (a.logarithmic && !(a.range[0] > 0.0)) throw cmap::UsageError("--range: a logarithmic scale begins above 0");
    options.range = {a.range[0], a.range[1]};
  }
  return options;
}

/// A camera from a file, or a view that is fitted to the map.
using CameraChoice = std::variant<cmap::Camera, cmap::View>;

CameraChoice camera_choice(const Arguments& a) {
  const bool is_file = a.camera == cmap::kStandardStream || a.camera.find_first_of("./") != std::string::npos;
  if (is_file) return cmap::read_camera(a.camera);
  return cmap::view_from_name(a.camera);
}

/// A picture, a turn or both; or a window.
void check_outputs(const Arguments& a) {
  const bool has_output = !a.output.empty() || !a.turntable.empty();
  if (!has_output && !a.interactive) throw cmap::UsageError("--output is required, or --turntable, or --interactive");
  if (has_output && a.interactive) throw cmap::UsageError("--interactive writes no file: its key s saves pictures");
  if (a.interactive) cmap::GlModule().require_display();
  if (!a.output.empty()) cmap::check_image_name(a.output);
  if (!a.output.empty()) cmap::require_writable(a.output);
  if (!a.turntable.empty()) cmap::check_turntable_name(a.turntable);
}

/// What is drawn and how, checked before the work.
struct Plan {
  explicit Plan(const Arguments& a) : options(figure_options(a)), layer(layer_options(a)), camera(camera_choice(a)) {
    cmap::refuse_overwriting({a.map, a.estimate, a.camera, a.transform}, {a.output, a.turntable});
    check_outputs(a);
    cmap::set_given(option_fields(evaluation), a.metrics);
    for (const std::string& panel : a.panels) cmap::check_layer_name(panel);
    (void)cmap::panel_aspect(std::max<std::size_t>(1, a.panels.size()), options);
  }
  cmap::FigureOptions options;
  cmap::LayerOptions layer;
  CameraChoice camera;
  cmap::EvaluationOptions evaluation;
};

/// What there is to see.
struct Scene {
  std::string title;
  std::vector<cmap::Layer> layers;
  const cmap::PointBlocks& points;  ///< that the camera is fitted to
  std::function<std::vector<std::string>(const cmap::PointBlocks& points, std::size_t slot)> describe_point;
};

using FittedCamera = cmap::Camera (*)(cmap::View, const cmap::PointBlocks&, double aspect, bool orthographic);

/// The camera that was asked for.
cmap::Camera camera_of(const Arguments& a, const Scene& scene, const Plan& plan, std::size_t n_panels,
                       FittedCamera fitted) {
  if (const auto* camera = std::get_if<cmap::Camera>(&plan.camera)) return *camera;
  return fitted(std::get<cmap::View>(plan.camera), scene.points, cmap::panel_aspect(n_panels, plan.options),
                a.orthographic);
}

void show_window(const Arguments& a, const Scene& scene, const Plan& plan) {
  const cmap::Camera camera = camera_of(a, scene, plan, 1, &cmap::camera_for);
  cmap::GlModule().view({scene.title, scene.layers, camera, plan.options, scene.describe_point});
}

void write_figure(const Arguments& a, const Scene& scene, const Plan& plan) {
  const cmap::Camera camera = camera_of(a, scene, plan, scene.layers.size(), &cmap::camera_for);
  cmap::OutputFile file(a.output);
  cmap::write_image(cmap::draw_figure(scene.layers, camera, plan.options), a.output, file);
  file.commit();
}

void write_turn(const Arguments& a, const Scene& scene, const Plan& plan, cmap::ProgressBar& progress) {
  const cmap::Camera camera = camera_of(a, scene, plan, scene.layers.size(), &cmap::turntable_camera_for);
  cmap::write_turntable(scene.layers, cmap::turntable_cameras(camera, a.frames), plan.options, a.turntable,
                        {.progress = [&](std::string_view stage, double done) { progress.update(stage, done); }});
}

void draw(const Arguments& a, const Scene& scene, const Plan& plan, cmap::ProgressBar& progress) {
  if (a.interactive) return show_window(a, scene, plan);
  if (!a.output.empty()) write_figure(a, scene, plan);
  if (!a.turntable.empty()) write_turn(a, scene, plan, progress);
}

void draw_map(const Arguments& a, const Plan& plan, cmap::ProgressBar& progress) {
  if (!a.panels.empty() || !a.transform.empty()) throw cmap::UsageError("--panels and --transform need a second map");
  progress.update("read", 0.0);
  const cmap::IndexedMap map(cmap::read_point_cloud(a.map, cmap::read_options(plan.evaluation)).cloud);
  const std::string name = cmap::file_name(a.map);
  const std::vector<cmap::Layer> layers{cmap::make_layer(map, name, plan.layer)};
  const auto describe = [&](const cmap::PointBlocks&, std::size_t slot) { return cmap::describe_point(map, slot); };
  draw(a, {name, layers, map.index.points, describe}, plan, progress);
}

/// What the panels and their captions need of an evaluation; color only where both maps have it.
cmap::EvaluationOptions evaluation_options(const Arguments& a, const Plan& plan, bool has_color) {
  cmap::EvaluationOptions options = plan.evaluation;
  options.metrics = {"chamfer"};
  if (has_color) options.metrics = {"chamfer", "color_distance", "local_color_recall"};
  for (const std::string& panel : a.panels) {
    const cmap::MetricInfo* metric = cmap::find_metric(cmap::metric_of_layer(panel));
    if (metric != nullptr && (has_color || !metric->needs_color)) options.metrics.emplace_back(metric->id);
  }
  return options;
}

void draw_pair(const Arguments& a, const Plan& plan, cmap::ProgressBar& progress) {
  std::vector<cmap::Warning> warnings;
  const Eigen::Matrix4d T_ref_est = cmap::transform_or_identity(a.transform, warnings);
  if (!a.common.quiet) cmap::print_warnings(warnings);
  progress.update("read", 0.0);
  auto [reference, estimate] = cmap::read_both(a.map, a.estimate, cmap::read_options(plan.evaluation));
  const bool has_color = reference.cloud.has_color() && estimate.cloud.has_color();
  const cmap::EvaluatedPair evaluation = cmap::evaluate(
      std::move(reference.cloud), std::move(estimate.cloud), evaluation_options(a, plan, has_color), T_ref_est,
      {.progress = [&](std::string_view stage, double done) { progress.update(stage, done); }});
  std::vector<cmap::Layer> layers;
  for (const std::string& panel : a.panels.empty() ? cmap::standard_panels(evaluation) : a.panels)
    layers.push_back(cmap::make_layer(evaluation, panel, plan.layer));
  const auto describe = [&](const cmap::PointBlocks& points, std::size_t slot) {
    return cmap::describe_point(evaluation, points, slot);
  };
  const std::string title = fmt::format("{}, {}", cmap::file_name(a.map), cmap::file_name(a.estimate));
  draw(a, {title, layers, evaluation.pair.reference.index.points, describe}, plan, progress);
}

cmap::ExitCode run(const Arguments& a) {
  const cmap::ExecutionScope scope({.threads = a.common.threads});
  const Plan plan(a);
  cmap::ProgressBar progress(!a.common.quiet);
  a.estimate.empty() ? draw_map(a, plan, progress) : draw_pair(a, plan, progress);
  return cmap::ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  cmap::CommandLine line("cmap_render", kDescription, std::string(kExample) + cmap::kDash);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(arguments); });
}
