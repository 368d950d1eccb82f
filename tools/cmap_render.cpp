// cmap_render MAP [EST]: off-screen pictures of a map, or of what is wrong with one.

#include <fmt/format.h>

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
#include "evaluation_arguments.hpp"
#include "files.hpp"
#include "program.hpp"

namespace {

constexpr const char* kDescription =
    "Draws a point-cloud map, or an estimated map beside its reference with what is wrong with it.\n"
    "Needs no display and no GPU; --interactive opens a window in which h shows the keys.\n"
    "Layers: reference, estimate, lcr, color-distance, distance, delta-e, ccs, wasserstein, density, height.";

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
  cmap::EvaluationArguments evaluation;
  cmap::CommonArguments common;
};

void add_options(CLI::App& app, Arguments& a) {
  app.add_option("MAP", a.map, "map to draw; with EST, the reference")->required()->type_name("FILE");
  app.add_option("EST", a.estimate, "estimated map")->type_name("FILE");
  app.add_option("-o,--output", a.output, "picture to write: .png, .jpg or .tif")->type_name("FILE");
  app.add_flag("--interactive", a.interactive, "a window to turn, zoom and pick points in; needs an X display");
  app.add_option("--panels", a.panels, "layers side by side [reference,estimate,lcr,color-distance]")
      ->type_name("LIST")
      ->delimiter(',')
      ->expected(1, 9);
  app.add_option("--camera", a.camera,
                 "top, oblique, front, side, fit, or a file: ours or one of Open3D, see below [oblique]")
      ->type_name("VIEW");
  app.add_flag("--orthographic", a.orthographic, "parallel projection");
  app.add_option("--size", a.size, "of the picture in pixels [1600x1000]")->type_name("WxH");
  app.add_option("--range", a.range, "ends of the color scale of heat maps, for pictures that are to be compared")
      ->type_name("LOW,HIGH")
      ->delimiter(',')
      ->expected(2)
      ->option_text("LOW,HIGH");
  app.add_flag("--log", a.logarithmic, "logarithmic color scale");
  app.add_option("--color-map", a.color_map, "viridis, cividis, inferno or turbo")->type_name("NAME");
  app.add_option("--background", a.background, "white, black or transparent [white]")->type_name("NAME");
  app.add_option("--point-size", a.point_size, "factor on the size of points [1]")
      ->type_name("FACTOR")
      ->check(CLI::Range(0.01, 100.0).description(""));
  app.add_option("--renderer", a.renderer, "splat, on the processor, or gl, by OpenGL: the same picture [splat]")
      ->type_name("NAME");
  app.add_option("--transform", a.transform, "4x4 matrix T_ref_est that moves the estimate into the reference frame")
      ->type_name("FILE");
  app.add_option("--turntable", a.turntable, "full turn around the map: .mp4, .gif, or a new folder of frames")
      ->type_name("NAME");
  app.add_option("--frames", a.frames, "of the turn, 24 a second [120]")
      ->type_name("N")
      ->check(CLI::Range(2, 10000).description(""));
  cmap::add_common_options(app, a.common, "no progress, and not which device OpenGL draws by");
  cmap::refuse_empty(app, {"--output", "--turntable", "--camera", "--color-map", "--renderer", "--transform"});
  a.evaluation.add_to(app, [](std::string_view name) {
    if (name == "keep-noise" || name == "classes") return true;
    return name.starts_with("lcr-") ? name != "lcr-curve" : name.starts_with("ccs-") || name.starts_with("awd-");
  });
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
    a.evaluation.apply_to(evaluation);
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
  const cmap::Evaluation evaluation = cmap::evaluate(
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
  CLI::App app(kDescription, "cmap_render");
  app.footer(std::string(kExample) + cmap::kDash);
  Arguments arguments;
  add_options(app, arguments);
  return cmap::run_program(app, argc, argv, [&] { return run(arguments); });
}
