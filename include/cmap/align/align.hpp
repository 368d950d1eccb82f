#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/align/alignment.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

struct AlignOptions {
  Eigen::Matrix4d T_initial = Eigen::Matrix4d::Identity();  ///< dst from src; not used by methods that need none
  /// Of the thinned source, in the target's units, at the finest level; without one the target's size / 400, but at
  /// least twice its points' median spacing. Finer: more accurate and slower.
  std::optional<double> voxel_m;
  /// Farther pairs are no matches at the finest level; without one 10 voxels. It must exceed what the initial transform
  /// is wrong by divided by 4 (levels begin 4 times as coarse), for sim3 (where it is the first gate) that itself.
  std::optional<double> max_distance_m;
  bool with_scale = false;  ///< estimate the scale too, where the method leaves the choice
  /// The smallest distance that is to be measured afterwards. Where no voxel is given, levels go on until it, but no
  /// finer than twice the target's median spacing; the pose that was judged moves by less than the voxel it was judged
  /// at.
  std::optional<double> finest_m;
  std::size_t most_points = 0;  ///< of the thinned source that take part in a level, spread evenly; 0: all
};

/// Whether a method estimates the scale.
enum class ScaleRule { kOnRequest, kAlways };

/// A way to register one map onto another: a source of its name in lib/align/methods/, that name in the module's
/// CMakeLists.txt, and a test of its name. Command lines, configuration files and --help follow.
struct RegistrationMethod {
  std::string_view name;
  std::string_view summary;        ///< for people: "point to plane"
  bool needs_initial = true;       ///< it starts from T_initial, near enough; else from nothing
  bool takes_max_distance = true;  ///< AlignOptions::max_distance_m
  ScaleRule scale = ScaleRule::kOnRequest;
  Alignment (*run)(const PointCloud& source, const PointCloud& target, const AlignOptions& options, double voxel_m);
};

/// All of them, in the order of --help.
std::span<const RegistrationMethod* const> registration_methods();
std::vector<std::string> registration_names();

/// By name; throws UsageError for others, naming them.
const RegistrationMethod& registration_method(std::string_view name);

/// Aligns a source map to a target map: one door to all methods. Units are meters; the clouds
/// may lie anywhere. Thread-safe; bitwise the same for any number of threads. Throws UnsupportedError where the
/// alignment cannot be determined (no overlap; a plane, line, sphere or corridor, saying which direction is free;
/// T_initial no similarity), UsageError for wrong options, std::invalid_argument on an empty cloud. Every result
/// carries a judgment: other poses, and the source's mirror image, are searched to compare with.
Alignment align(const PointCloud& source, const PointCloud& target, const RegistrationMethod& method,
                const AlignOptions& options = {}, const Execution& execution = {});

/// The voxel that align() takes where none is given.
double default_align_voxel_m(const PointCloud& target);

/// Everything in an Alignment as JSON: units in the names, T_dst_src as rows, `score` null where nothing was judged.
nlohmann::ordered_json alignment_json(const Alignment& alignment);

}  // namespace cmap
