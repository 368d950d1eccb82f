// cmap_align SRC DST: the transform that moves one map, or one trajectory, onto another.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cmap/align/align.hpp"
#include "cmap/align/tanks_and_temples.hpp"
#include "cmap/align/trajectory.hpp"
#include "files.hpp"
#include "program.hpp"

namespace {

constexpr const char* kDescription =
    "Finds the transform T_dst_src that moves a point-cloud map SRC onto another, DST, in the frame of DST.\n"
    "Methods, from a start near enough (--initial, or the identity): icp (point to point), plane, gicp (all rigid),\n"
    "sim3 (with scale, held near the start's at first), tanksandtemples (that benchmark's refinement and scores);\n"
    "without a start: global (rigid, or with --scale). trajectory: SRC and DST are poses (TUM, EuRoC, KITTI, or\n"
    "columns that a header line names), paired by time.";

constexpr const char* kExample =
    "Example:\n"
    "  cmap_align data_samples/town/estimate.ply data_samples/town/reference.ply --method gicp --voxel 0.2 -o T.txt\n"
    "\n"
    "Exit codes: 0 done; 2 wrong usage; 3 an input is missing, malformed or without a finite point;\n"
    "4 the alignment cannot be determined: no overlap, or a direction that the geometry leaves free; 70 internal "
    "error.";

struct Arguments {
  std::string source, target, method = "gicp", initial, times, output, json, fit = "sim3";
  double voxel_m = 0.0, max_distance_m = 0.0, tau_m = 0.0, max_gap_s = 0.15;
  bool scale = false, keep_noise = false;
  std::vector<std::uint8_t> classes;
  cmap::CommonArguments common;
};

void add_options(CLI::App& app, Arguments& a) {
  const auto positive = CLI::Range(1e-9, 1e9).description("");
  app.add_option("SRC", a.source, "map or trajectory to move")->required()->type_name("FILE");
  app.add_option("DST", a.target, "map or trajectory that stays")->required()->type_name("FILE");
  app.add_option("--method", a.method, "icp, plane, gicp, sim3, global, tanksandtemples, trajectory [gicp]")
      ->type_name("NAME")
      ->check(
          CLI::IsMember({"icp", "plane", "gicp", "sim3", "global", "tanksandtemples", "trajectory"}).description(""));
  app.add_option("-o,--output", a.output, "transform to write: 4x4 as text")->type_name("FILE");
  app.add_option("--json", a.json, "everything about the result, to write")->type_name("FILE");
  app.add_option("--initial", a.initial, "4x4 matrix T_dst_src to start from [identity]")->type_name("FILE");
  app.add_option("--voxel", a.voxel_m, "the source is thinned to this, the target to half [size of DST / 400]")
      ->type_name("M")
      ->check(positive);
  app.add_option("--max-distance", a.max_distance_m, "farther pairs are no matches [10 voxels]")
      ->type_name("M")
      ->check(positive);
  app.add_flag("--scale", a.scale, "estimate the scale too (icp, plane, gicp, global)");
  app.add_option("--tau", a.tau_m, "threshold of tanksandtemples")->type_name("M")->check(positive);
  app.add_option("--fit", a.fit, "of trajectories: first-frame, se3, sim3 [sim3]")
      ->type_name("NAME")
      ->check(CLI::IsMember({"first-frame", "se3", "sim3"}).description(""));
  app.add_option("--max-gap", a.max_gap_s, "poses farther apart are not interpolated between [0.15]")
      ->type_name("S")
      ->check(positive);
  const auto [source, target] = cmap::read_both(a.source, a.target, {.keep_noise = a.keep_noise, .classes = a.classes});
  if (a.method == "tanksandtemples") return run_tanks_and_temples(a, source.cloud, target.cloud, options.T_initial);
