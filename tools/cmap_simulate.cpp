// cmap_simulate PRESET -o DIR: a synthetic capture with exact ground truth.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "cmap/core/execution.hpp"
#include "cmap/core/progress.hpp"
#include "cmap/sim/capture_simulation.hpp"
#include "command_line.hpp"
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
  std::optional<int> seed;
  std::vector<std::string> assignments;
  bool print_options = false;
  cmap::CommonArguments common;
};

void add_options(cmap::CommandLine& line, Arguments& a) {
  line.add("PRESET", a.preset, "NAME|FILE", "name, or file of options").required().not_empty();
  line.add("-o,--output", a.output, "DIR", "folder to make").not_empty();
  line.add("--seed", a.seed, "N", "of noise and sway; the scene has its own, scene.seed [the preset's]")
      .between(0, 2147483647);
  line.add("--set", a.assignments, "SECTION.FIELD=VALUE", "an option by its name; may be repeated")
      .one_at_a_time()
      .not_empty();
  line.add_flag("--print-options", a.print_options, "all options as JSON, and nothing else");
  cmap::add_common_options(line, a.common, "no progress");
}

cmap::CaptureOptions options_of(const Arguments& a) {
  cmap::CaptureOptions options;
  const std::vector<std::string> presets = cmap::capture_preset_names();
  if (std::ranges::find(presets, a.preset) != presets.end() || a.preset.find_first_of("./") == std::string::npos) {
    cmap::apply_capture_preset(options, a.preset);
  } else {
    cmap::apply_capture_config_file(options, a.preset);
  }
  for (const std::string& assignment : a.assignments) cmap::set_capture_option(options, assignment);
  if (a.seed) options.seed = *a.seed;
  return options;
}

cmap::ExitCode run(const Arguments& a) {
  const cmap::ExecutionScope scope({.threads = a.common.threads});
  const cmap::CaptureOptions options = options_of(a);
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
  cmap::CommandLine line("cmap_simulate", kDescription, kExample);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(arguments); });
}
