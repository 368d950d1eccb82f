#include "cmap/align/align.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "icp/registration_cloud.hpp"
#include "last_steps.hpp"
#include "verdict/judge.hpp"

namespace cmap {
namespace {

constexpr double kVoxelsPerSize = 400.0;

/// From the 0.5 to the 99.5 % quantile of an axis: strays do not count.
double extent_m(const PointCloud& cloud, int axis) {
  Array<float> values(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) values[i] = cloud.positions[i][axis];
  const std::size_t tail = values.size() / 200;
  const double lowest = value_at_rank(values, tail);
  return value_at_rank(values, values.size() - 1 - tail) - lowest;
}

/// The finest voxel that points support: twice their median spacing.
double finest_voxel_m(const PointCloud& cloud) {
  constexpr std::size_t kSample = 20'000;
  constexpr double kSpacings = 2.0;
  const Bvh index(sort_points(cloud));
  Array<std::uint32_t> slots;
  for (std::size_t slot = 0; slot < cloud.size(); slot += cloud.size() / kSample + 1) {
    slots.push_back(static_cast<std::uint32_t>(slot));
  }
  return kSpacings * median_spacing_m(index, slots);
}

/// By size, where the points support it.
double voxel_by_size_m(const PointCloud& target, double finest_m) {
  const double size_m = Eigen::Vector3d(extent_m(target, 0), extent_m(target, 1), extent_m(target, 2)).norm();
  if (!(size_m > 0.0)) throw UnsupportedError("all points of the target coincide");
  return std::max(size_m / kVoxelsPerSize, finest_m);
}

void require_positive(const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw UsageError(fmt::format("{} is {:g}: above 0 is needed", name, value));
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
  return voxel_by_size_m(target, finest_voxel_m(target));
}

Alignment align(const PointCloud& source, const PointCloud& target, const RegistrationMethod& method,
                const AlignOptions& options, const Execution& execution) {
  const ExecutionScope scope(execution);
  if (source.positions.empty() || target.positions.empty()) {
    throw std::invalid_argument("a registration needs points");
  }
  const double finest_m = options.voxel_m ? 0.0 : finest_voxel_m(target);
  const double voxel_m = options.voxel_m.value_or(voxel_by_size_m(target, finest_m));
  require_positive("voxel_m", voxel_m);
  if (options.finest_m) require_positive("finest_m", *options.finest_m);
  Alignment found = method.run(source, target, options, voxel_m);
  const bool with_scale = options.with_scale || method.scale == ScaleRule::kAlways;
  const bool is_exact = found.voxel_m > 0.0 && settle_on_common_points(source, target, with_scale, found);
  if (found.judgment.verdict == Verdict::kNotJudged) found.judgment = judge_alignment(source, target, found);
  const bool is_to_go_on = options.finest_m && !options.voxel_m && !is_exact && is_trusted(found.judgment.verdict);
  if (is_to_go_on) sharpen(source, target, method, with_scale, std::max(*options.finest_m, finest_m), found);
  return found;
}

}  // namespace cmap
