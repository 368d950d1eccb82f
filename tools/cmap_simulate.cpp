// cmap_simulate PRESET -o DIR: a synthetic capture with exact ground truth.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cmap/core/execution.hpp"
#include "cmap/core/progress.hpp"
#include "cmap/sim/capture_simulation.hpp"
#include "program.hpp"

namespace {

constexpr const char* kDescription =
    "Simulates a capture: a scene, and what a LiDAR, an IMU and a camera carried through it record, with sessions of\n"
    "predictions like VGGT's, and the exact truth. PRESET is town, indoor, aerial, a small one of each for tests\n"
    "(small_town, ...), or a JSON file of options. All options: --print-options.";

constexpr const char* kExample =
    "Example:\n"
    "  cmap_simulate small_town -o capture --seed 2 --set lidar.model=mid360 --set path.speed_mps=2\n"
    "\n"
    "Exit codes: 0 done; 2 wrong usage, or the folder exists or cannot be written; 3 a mesh scene is missing or\n"
    "malformed; 70 internal error.";

struct Arguments {
  std::string preset, output;
  int seed = 0;
  std::vector<std::string> assignments;
  bool print_options = false;
  cmap::CommonArguments common;
};

void add_options(CLI::App& app, Arguments& a) {
  app.add_option("PRESET", a.preset, "name, or file of options")->required()->type_name("NAME|FILE");
  app.add_option("-o,--output", a.output, "folder to make")->type_name("DIR");
  app.add_option("--seed", a.seed, "of noise and sway; the scene has its own, scene.seed [the preset's]")
      ->type_name("N")
      ->check(CLI::Range(0, 2147483647).description(""));
  app.add_option("--set", a.assignments, "an option by its name; may be repeated")
      ->type_name("SECTION.FIELD=VALUE")
      ->allow_extra_args(false);
  app.add_flag("--print-options", a.print_options, "all options as JSON, and nothing else");
  cmap::add_common_options(app, a.common, "no progress");
  cmap::refuse_empty(app, {"PRESET", "--output", "--set"});
}

cmap::CaptureOptions options_of(const CLI::App& app, const Arguments& a) {
  cmap::CaptureOptions options;
  const std::vector<std::string> presets = cmap::capture_preset_names();
  if (std::ranges::find(presets, a.preset) != presets.end() || a.preset.find_first_of("./") == std::string::npos) {
    cmap::apply_capture_preset(options, a.preset);
  } else {
    cmap::apply_capture_config_file(options, a.preset);
  }
  for (const std::string& assignment : a.assignments) cmap::set_capture_option(options, assignment);
  if (app.get_option("--seed")->count() > 0) options.seed = a.seed;
  return options;
}

cmap::ExitCode run(const CLI::App& app, const Arguments& a) {
  const cmap::ExecutionScope scope({.threads = a.common.threads});
  const cmap::CaptureOptions options = options_of(app, a);
  if (a.print_options) {
    cmap::print(cmap::to_json(options).dump(2) + "\n");
    return cmap::ExitCode::kDone;
  }
  if (a.output.empty()) throw cmap::UsageError("--output is required");
  cmap::ProgressBar bar(!a.common.quiet);
  cmap::simulate_capture(options, a.output,
                         {.progress = [&](std::string_view stage, double done) { bar.update(stage, done); }});
  return cmap::ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(kDescription, "cmap_simulate");
  app.footer(kExample);
  Arguments arguments;
  add_options(app, arguments);
  return cmap::run_program(app, argc, argv, [&] { return run(app, arguments); });
}
