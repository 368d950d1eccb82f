#include "cmap/recon/post_fusion.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/spatial/nearest.hpp"

namespace cmap {
namespace {

constexpr std::array<std::string_view, 4> kNames{"prefusion", "normal", "paper", "robust"};

Sim3IcpOptions options_for(Registration registration, double voxel_m, double sigma_m) {
  if (registration == Registration::kNormal) return Sim3IcpOptions::normal(voxel_m);
  if (registration == Registration::kPaper) return Sim3IcpOptions::paper(voxel_m);
  return Sim3IcpOptions::robust(voxel_m, sigma_m);
}

/// How well the session's points lie on the LiDAR's, whatever moved them there: matches within three voxels.
void measure_fit(const PointCloud& session, const Bvh& lidar, double voxel_m, LidarRegistration& result) {
  const PointCloud thinned = voxel_thinned(session, voxel_m);
  const NearestField nearest = find_nearest(lidar, sort_points(thinned));
  const double sq_gate_m2 = 9.0 * voxel_m * voxel_m;
  double sum_m2 = 0.0;
  for (const double sq_dist : nearest.sq_dist) {
    if (!(sq_dist <= sq_gate_m2)) continue;
    sum_m2 += sq_dist;
    ++result.n_matches;
  }
  result.overlap = static_cast<double>(result.n_matches) / static_cast<double>(thinned.size());
  result.rmse_m = result.n_matches > 0 ? std::sqrt(sum_m2 / static_cast<double>(result.n_matches)) : 0.0;
}

LidarRegistration kept(const Similarity& T_world_session, std::string why) {
  LidarRegistration result;
  result.T_world_session = T_world_session;
  result.accepted = false;
  result.flags.push_back(std::move(why));
  return result;
}

/// Without a measure of the fit.
LidarRegistration moved_session(const SessionCloud& session, const PointCloud& lidar, const Similarity& T_world_session,
                                Registration registration, double voxel_m, double sigma_m) {
  const bool with_weights = registration == Registration::kRobust;
  try {
    const Sim3Alignment found =
        sim3_icp(session.cloud, lidar, Eigen::Matrix4d::Identity(), options_for(registration, voxel_m, sigma_m),
                 with_weights ? std::span<const float>(session.confidence) : std::span<const float>{});
    LidarRegistration result;
    result.T_world_session = similarity_from(found.T_dst_src) * T_world_session;
    result.scale_change = found.scale;
    result.iterations = found.iterations;
    result.accepted = found.accepted;
    result.flags = found.warnings;
    return result;
  } catch (const UnsupportedError& error) {
    return kept(T_world_session, error.what());
  }
}

/// Mean of the squared distances, those beyond the three voxels of a match counted as three.
double truncated_cost_m2(const LidarRegistration& result, double voxel_m) {
  return result.overlap * result.rmse_m * result.rmse_m + (1.0 - result.overlap) * 9.0 * voxel_m * voxel_m;
}

}  // namespace

Registration registration_from_name(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<Registration>(i);
  }
  throw UsageError(fmt::format("registration \"{}\" is none of prefusion, normal, paper, robust", name));
}

std::string_view registration_name(Registration registration) { return kNames[static_cast<std::size_t>(registration)]; }

LidarRegistration register_on_lidar(const SessionCloud& session, const PointCloud& lidar,
                                    const Similarity& T_world_session, Registration registration, double voxel_m,
                                    double sigma_m) {
  if (session.cloud.positions.empty()) return kept(T_world_session, "the session has no points");
  if (lidar.positions.empty()) return kept(T_world_session, "the LiDAR has no points at the session's time");
  const Bvh target(sort_points(lidar));
  LidarRegistration before;
  before.T_world_session = T_world_session;
  measure_fit(session.cloud, target, voxel_m, before);
  if (registration == Registration::kPrefusion) return before;
  LidarRegistration result = moved_session(session, lidar, T_world_session, registration, voxel_m, sigma_m);
  const Similarity step = result.T_world_session * T_world_session.inverse();
  measure_fit(transformed(session.cloud, step.matrix()), target, voxel_m, result);
  const bool is_better = truncated_cost_m2(result, voxel_m) < truncated_cost_m2(before, voxel_m);
  if (registration != Registration::kRobust || !result.accepted || is_better) return result;
  before.accepted = false;
  before.flags.push_back("registration fits no better than pre-fusion, which is kept");
  return before;
}

}  // namespace cmap
