#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cmap/align/align_method.hpp"
#include "cmap/align/trajectory_fit.hpp"
#include "cmap/core/options.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/metrics/metric_options.hpp"
#include "cmap/spatial/nearest.hpp"
#include "cmap/spatial/visibility.hpp"

namespace cmap {

struct PeerTool;

/// How it is told what of one map the other could have seen, so that the rest can be left out beside the plain numbers:
/// not at all, from where the maps have points, or (the reference) from where the estimate's sensor was.
enum class Observed { kNone, kAuto, kSensor };

/// Everything that can change a number of an evaluation. The defaults are those of METRICS: the paper's where it gives
/// any. A field here and its line in option_fields() are all that an option is.
struct EvaluationOptions : MetricOptions {
  EvaluationOptions() = default;  // g++ 12 takes an aggregate's `{}` for uninitialized

  std::vector<std::string> metrics;  ///< groups or metric ids; empty: color, geometry, distribution, as far as possible
  std::optional<double> voxel_m;     ///< thin both maps first
  std::optional<Box3d> crop;         ///< reference frame
  std::vector<const PeerTool*> as;   ///< other tools
  std::uint64_t bootstrap = 0;       ///< replicates for confidence intervals; 0: none
  double block_m = 10.0;             ///< of the bootstrap
  std::uint64_t bootstrap_seed = 1;
  Observed observed = Observed::kNone;
  VisibilityOptions visibility = {};  ///< of the sensor
  AlignMethod align;
  std::optional<double> align_voxel_m;
  std::optional<double> align_distance_m;
  bool align_scale = false;
  bool allow_unconverged = false;  ///< score an alignment that is not to be trusted all the same
  TrajectoryFit trajectory_fit = TrajectoryFit::kSim3;
  TimePairing trajectory_pairing = TimePairing::kInterpolated;
  double trajectory_max_gap_s = 0.15;
  std::optional<double> trajectory_time_offset_s;
  std::optional<double> tanks_and_temples_tau_m;
  bool sensitivity = false;
  double sensitivity_translation_m = 0.01;
  double sensitivity_rotation_deg = 0.1;
  IndexKind index = IndexKind::kBvh;
  bool keep_noise = false;            ///< LAS: of classes 7 and 18
  std::vector<std::uint8_t> classes;  ///< LAS: these only; empty: all
};

/// What of it decides how files are read.
ReadOptions read_options(const EvaluationOptions& options, bool sha256 = false);

/// The threshold of Tanks and Temples: as given, else the largest of the thresholds.
double tanks_and_temples_tau_m(const EvaluationOptions& options);

/// Each of them as users see it: its name on the command line and in files and reports, its rule and its help. The
/// options must outlive the list.
OptionFields option_fields(EvaluationOptions& options);

}  // namespace cmap
