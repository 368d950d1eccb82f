#include "cmap/align/align.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cmap/align/icp.hpp"
#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/io/transform_file.hpp"
#include "cmap/spatial/k_nearest.hpp"
#include "verdict/judge.hpp"

namespace cmap {
namespace {

constexpr double kVoxelsPerSize = 400.0, kSpacingsPerVoxel = 2.0;

/// From the 0.5 to the 99.5 % quantile of an axis: strays do not count.
double extent_m(const PointCloud& cloud, int axis) {
  Array<float> values(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) values[i] = cloud.positions[i][axis];
  const std::size_t tail = values.size() / 200;
  const double lowest = value_at_rank(values, tail);
  return value_at_rank(values, values.size() - 1 - tail) - lowest;
}

double median_spacing_m(const PointCloud& cloud) {
  constexpr std::size_t kSample = 20'000;
  const Bvh index(sort_points(cloud));
  Array<std::uint32_t> slots;
  for (std::size_t slot = 0; slot < cloud.size(); slot += cloud.size() / kSample + 1) {
    slots.push_back(static_cast<std::uint32_t>(slot));
  }
  const Array<std::uint32_t> nearest_two = find_k_nearest(index, chosen_points(index.points, slots), 2);
  Array<double> spacing_m(slots.size());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const std::uint32_t other = nearest_two[2 * i + 1];
    spacing_m[i] = other == kNoNeighbor ? 0.0 : (index.points.offset(slots[i]) - index.points.offset(other)).norm();
  }
  return upper_median(spacing_m);
}

/// Thinning leaves an error of some share of the voxel. Where both clouds hold the same points, as a copy does, the
/// points themselves leave none: they are tried, and taken where they come to lie on each other. Returns whether.
bool settle_on_common_points(const PointCloud& source, const PointCloud& target, bool with_scale, Alignment& found) {
  constexpr std::size_t kSample = 100'000, kFew = 2'000;
  constexpr double kSamePoint = 0.02;  // of the voxel; samples of a surface taken twice are farther apart
  IcpOptions options;
  options.metric = IcpMetric::kPoint;
  options.with_scale = with_scale;
  options.levels = {{0.0, found.voxel_m, 50}};
  const auto is_copy = [&](const Alignment& settled) {
    return settled.rmse_m < kSamePoint * found.voxel_m && settled.overlap >= found.overlap - kSamePoint;
  };
  try {
    if (!is_copy(icp(sampled(source, kFew), target, found.T_dst_src, options))) return false;
    const Alignment settled = icp(sampled(source, kSample), target, found.T_dst_src, options);
    if (!is_copy(settled)) return false;
    found.T_dst_src = settled.T_dst_src;
    found.scale = settled.scale;
    found.rmse_m = settled.rmse_m;
    return true;
  } catch (const UnsupportedError&) {
    return false;  // too few points so near to each other: no copy
  }
}

double farthest_move_m(const PointCloud& source, const Eigen::Matrix4d& from, const Eigen::Matrix4d& to) {
  double sq_dist = 0.0;
  for (const Eigen::Vector3d& corner : corners(bounds(source))) {
    sq_dist = std::max(sq_dist, ((to - from) * corner.homogeneous()).squaredNorm());
  }
  return std::sqrt(sq_dist);
}

/// Goes on from what was found to the finest distance that is to be measured. A step that leads away from what was
/// judged is not taken.
void sharpen(const PointCloud& source, const PointCloud& target, const RegistrationMethod& method,
             const AlignOptions& options, Alignment& found) {
  constexpr std::size_t kMostPoints = 100'000;
  constexpr double kWorthIt = 0.75;  // of the voxel so far
  const double voxel_m = std::max(*options.finest_m, kSpacingsPerVoxel * median_spacing_m(target));
  if (voxel_m > kWorthIt * found.voxel_m) return;
  const bool is_own = method.needs_initial && method.scale == ScaleRule::kOnRequest;
  const RegistrationMethod& finer = is_own ? method : registration_method("gicp");
  try {
    AlignOptions how;
    how.T_initial = found.T_dst_src;
    how.with_scale = options.with_scale || method.scale == ScaleRule::kAlways;
    how.most_points = kMostPoints;
    Alignment sharper = finer.run(source, target, how, voxel_m);
    if (farthest_move_m(source, found.T_dst_src, sharper.T_dst_src) > found.voxel_m) return;
    sharper.method = found.method;
    sharper.judgment = found.judgment;
    sharper.iterations += found.iterations;
    found = std::move(sharper);
  } catch (const UnsupportedError&) {
    // Too little lies so near to each other: what was found stands.
  }
}

void require_positive(const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw UsageError(fmt::format("{} is {:g}: above 0 is needed", name, value));
}

nlohmann::ordered_json directions_json(const std::vector<WeakDirection>& directions) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const WeakDirection& d : directions) {
    json.push_back({{"direction", d.name}, {"standard_error_m", d.standard_error_m}});
  }
  return json;
}

void add_judgment(const Judgment& judgment, nlohmann::ordered_json& json) {
  const bool is_judged = judgment.verdict != Verdict::kNotJudged;
  json["verdict"] = name_of(judgment.verdict, verdict_names());
  json["reason"] = judgment.reason;
  json["help"] = judgment.help;
  json["score"] = is_judged ? nlohmann::ordered_json(judgment.score) : nlohmann::ordered_json(nullptr);
  json["rivals"] = nlohmann::ordered_json::array();
  for (const RivalPose& rival : judgment.rivals) {
    json["rivals"].push_back({{"T_dst_src", transform_json(rival.T_dst_src)}, {"score", rival.score}});
  }
  json["weak"] = directions_json(judgment.weak);
}

}  // namespace

std::vector<std::string> registration_names() {
  std::vector<std::string> names;
  for (const RegistrationMethod* method : registration_methods()) names.emplace_back(method->name);
  return names;
}

const RegistrationMethod& registration_method(std::string_view name) {
  for (const RegistrationMethod* method : registration_methods()) {
    if (method->name == name) return *method;
  }
  throw UsageError(fmt::format("method \"{}\" is none of {}", name, fmt::join(registration_names(), ", ")));
}

double default_align_voxel_m(const PointCloud& target) {
  if (target.positions.empty()) throw std::invalid_argument("a registration needs points");
  const double size_m = Eigen::Vector3d(extent_m(target, 0), extent_m(target, 1), extent_m(target, 2)).norm();
  if (!(size_m > 0.0)) throw UnsupportedError("all points of the target coincide");
  return std::max(size_m / kVoxelsPerSize, kSpacingsPerVoxel * median_spacing_m(target));
}

Alignment align(const PointCloud& source, const PointCloud& target, const RegistrationMethod& method,
                const AlignOptions& options, const Execution& execution) {
  const ExecutionScope scope(execution);
  if (source.positions.empty() || target.positions.empty()) {
    throw std::invalid_argument("a registration needs points");
  }
  const double voxel_m = options.voxel_m.value_or(default_align_voxel_m(target));
  require_positive("voxel_m", voxel_m);
  if (options.finest_m) require_positive("finest_m", *options.finest_m);
  Alignment found = method.run(source, target, options, voxel_m);
  const bool with_scale = options.with_scale || method.scale == ScaleRule::kAlways;
  const bool is_exact = found.voxel_m > 0.0 && settle_on_common_points(source, target, with_scale, found);
  if (found.judgment.verdict == Verdict::kNotJudged) found.judgment = judge_alignment(source, target, found);
  if (options.finest_m && !options.voxel_m && !is_exact) sharpen(source, target, method, options, found);
  return found;
}

nlohmann::ordered_json alignment_json(const Alignment& a) {
  nlohmann::ordered_json json{{"method", a.method},         {"T_dst_src", transform_json(a.T_dst_src)},
                              {"scale", a.scale},           {"overlap", a.overlap},
                              {"rmse_m", a.rmse_m},         {"n_source", a.n_source},
                              {"n_target", a.n_target},     {"n_matches", a.n_matches},
                              {"condition", a.condition},   {"weakest_direction", a.weakest},
                              {"iterations", a.iterations}, {"converged", a.converged},
                              {"voxel_m", a.voxel_m},       {"max_distance_m", a.max_distance_m},
                              {"warnings", a.warnings}};
  json["standard_errors"] = directions_json(a.standard_errors);
  add_judgment(a.judgment, json);
  return json;
}

}  // namespace cmap
