#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/metrics/metric_options.hpp"
#include "cmap/spatial/nearest.hpp"
#include "cmap/spatial/visibility.hpp"

namespace cmap {

/// How it is told what of one map the other could have seen, so that the rest can be left out beside the plain numbers:
/// not at all, from where the maps have points, or (the reference) from where the estimate's sensor was.
enum class Observed { kNone, kAuto, kSensor };

/// Everything that can change a number of an evaluation. The defaults are those of METRICS: the paper's where it gives
/// any. Command line, configuration files and reports name the fields as evaluation_option_specs() does.
struct EvaluationOptions : MetricOptions {
  EvaluationOptions() = default;  // g++ 12 takes an aggregate's `{}` for uninitialized

  std::vector<std::string> metrics;  ///< groups or metric ids; empty: color, geometry, distribution, as far as possible
  std::optional<double> voxel_m;     ///< thin both maps first
  std::optional<Box3d> crop;         ///< reference frame
  std::vector<std::string> as;       ///< other tools, as peer_names() has them
  std::uint64_t bootstrap = 0;       ///< replicates for confidence intervals; 0: none
  double block_m = 10.0;             ///< of the bootstrap
  Observed observed = Observed::kNone;
  VisibilityOptions visibility = {};  ///< of the sensor
  std::string align = "none";         ///< icp, plane, gicp, sim3, global, trajectory, tanksandtemples
  std::optional<double> align_voxel_m;
  std::optional<double> align_distance_m;
  bool align_scale = false;
  std::string trajectory_fit = "sim3";  ///< first-frame, se3, sim3
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

enum class OptionKind { kNumber, kCount, kFlag, kNumbers, kWords, kWord };

/// One field of EvaluationOptions as users see it.
struct OptionSpec {
  const char* name;  ///< on the command line without the dashes, in files and reports
  OptionKind kind;
  const char* placeholder;  ///< "METERS", "LIST", ...
  const char* help;
  /// Sets the field from a value of the kind's JSON type. Throws UsageError naming the option, the value and the rule.
  void (*set)(EvaluationOptions&, const nlohmann::ordered_json&);
  nlohmann::ordered_json (*get)(const EvaluationOptions&);
};

const std::vector<OptionSpec>& evaluation_option_specs();

/// Sets an option from the text of a command line ("0.2,0.1", "true"). Throws UsageError.
void set_option(EvaluationOptions& options, const OptionSpec& spec, const std::string& text);

/// The other way: an option's value as one would type it, empty for none.
std::string command_line_text(const nlohmann::ordered_json& value);

/// Applies a JSON object (comments allowed) of option names and values. Throws UsageError naming `source` and the key:
/// unknown key, wrong type, value out of range.
void apply_config(EvaluationOptions& options, const std::string& json_text, const std::string& source);
void apply_config_file(EvaluationOptions& options, const std::filesystem::path& path);

/// The shipped configurations of configs/: "paper", "indoor", "outdoor", "aerial", "mapeval".
std::vector<std::string> preset_names();
void apply_preset(EvaluationOptions& options, const std::string& name);

/// All options after defaults, by name, as the report's `parameters`.
nlohmann::ordered_json to_json(const EvaluationOptions& options);

}  // namespace cmap
