#include "cmap/align/align.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cmap/align/global.hpp"
#include "cmap/align/icp.hpp"
#include "cmap/align/sim3_icp.hpp"
#include "cmap/core/error.hpp"
#include "cmap/spatial/k_nearest.hpp"

namespace cmap {
namespace {

constexpr std::array<std::string_view, 5> kNames{"icp", "plane", "gicp", "sim3", "global"};
constexpr double kVoxelsPerSize = 400.0;
constexpr double kGateVoxels = 10.0;

/// From the 0.5 to the 99.5 % quantile of an axis: strays do not count.
double extent_m(const PointCloud& cloud, int axis) {
  Array<float> values(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) values[i] = cloud.positions[i][axis];
  const std::size_t tail = values.size() / 200;
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(tail);
  const auto high = values.end() - 1 - static_cast<std::ptrdiff_t>(tail);
  std::nth_element(values.begin(), low, values.end());
  const double lowest = *low;
  std::nth_element(values.begin(), high, values.end());
  return *high - lowest;
}

double median_spacing_m(const PointCloud& cloud) {
  const Bvh index(sort_points(cloud));
  const Array<std::uint32_t> nearest_two = find_k_nearest(index, index.points, 2);
  Array<double> spacing_m(cloud.size());
  for (std::size_t slot = 0; slot < cloud.size(); ++slot) {
    const std::uint32_t other = nearest_two[2 * slot + 1];
    spacing_m[slot] = other == kNoNeighbor ? 0.0 : (index.points.offset(slot) - index.points.offset(other)).norm();
  }
  const auto middle = spacing_m.begin() + static_cast<std::ptrdiff_t>(spacing_m.size() / 2);
  std::nth_element(spacing_m.begin(), middle, spacing_m.end());
  return *middle;
}

Alignment align_sim3(const PointCloud& source, const PointCloud& target, const AlignOptions& options, double voxel_m) {
  Sim3IcpOptions sim3 = Sim3IcpOptions::robust(voxel_m);
  if (options.max_distance_m) {
    sim3.gate0_m = *options.max_distance_m;
    sim3.gate1_m = std::min(sim3.gate1_m, sim3.gate0_m);
  }
  Sim3Alignment result = sim3_icp(source, target, options.T_initial, sim3);
  if (!result.accepted) {
    // Whoever asks for an alignment has no use for the start.
    const std::string& why = result.warnings.back();
    throw UnsupportedError(why.substr(why.find(": ") + 2));
  }
  return static_cast<Alignment&&>(result);
}

}  // namespace

AlignMethod align_method_from_name(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw UsageError(fmt::format("method \"{}\" is none of icp, plane, gicp, sim3, global", name));
  }
  return static_cast<AlignMethod>(found - kNames.begin());
}

double default_align_voxel_m(const PointCloud& target) {
  if (target.positions.empty()) throw std::invalid_argument("a registration needs points");
  const double size_m = Eigen::Vector3d(extent_m(target, 0), extent_m(target, 1), extent_m(target, 2)).norm();
  if (!(size_m > 0.0)) throw UnsupportedError("all points of the target coincide");
  return std::max(size_m / kVoxelsPerSize, 2.0 * median_spacing_m(target));
}

Alignment align(const PointCloud& source, const PointCloud& target, AlignMethod method, const AlignOptions& options) {
  if (source.positions.empty() || target.positions.empty()) {
    throw std::invalid_argument("a registration needs points");
  }
  const double voxel_m = options.voxel_m.value_or(default_align_voxel_m(target));
  if (!(voxel_m > 0.0) || !std::isfinite(voxel_m)) {
    throw UsageError(fmt::format("voxel_m is {:g}: above 0 is needed", voxel_m));
  }
  if (method == AlignMethod::kSim3) return align_sim3(source, target, options, voxel_m);
  if (method == AlignMethod::kGlobal) {
    GlobalOptions global;
    global.with_scale = options.with_scale;
    global.fine_voxel_m = voxel_m;
    return global_registration(source, target, global);
  }
  IcpOptions icp_options;
  icp_options.metric = static_cast<IcpMetric>(method);
  icp_options.with_scale = options.with_scale;
  icp_options.levels = coarse_to_fine(voxel_m, options.max_distance_m.value_or(kGateVoxels * voxel_m), 100);
  return icp(source, target, options.T_initial, icp_options);
}

nlohmann::ordered_json alignment_json(const Alignment& a) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int row = 0; row < 4; ++row) {
    rows.push_back({a.T_dst_src(row, 0), a.T_dst_src(row, 1), a.T_dst_src(row, 2), a.T_dst_src(row, 3)});
  }
  return {{"method", a.method},         {"T_dst_src", rows},
          {"scale", a.scale},           {"overlap", a.overlap},
          {"rmse_m", a.rmse_m},         {"n_source", a.n_source},
          {"n_target", a.n_target},     {"n_matches", a.n_matches},
          {"condition", a.condition},   {"weakest_direction", a.weakest},
          {"iterations", a.iterations}, {"converged", a.converged},
          {"voxel_m", a.voxel_m},       {"max_distance_m", a.max_distance_m},
          {"warnings", a.warnings}};
}

}  // namespace cmap
