#include "cmap/recon/registration.hpp"

#include <algorithm>
#include <cmath>

#include "cmap/align/sim3_icp.hpp"
#include "cmap/core/error.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/spatial/nearest.hpp"

namespace cmap {
namespace {

double sq_match_gate_m2(const RegistrationOptions& options) {
  return options.match_gate * options.match_gate * options.voxel_m * options.voxel_m;
}

Sim3IcpOptions icp_options(const RegistrationOptions& o, double sigma_m) {
  const bool is_robust = o.method == SessionRegistrationMethod::kRobust;
  Sim3IcpOptions options = is_robust ? Sim3IcpOptions::robust(o.voxel_m, sigma_m) : Sim3IcpOptions::paper(o.voxel_m);
  options.beta0 = options.beta1 = o.method == SessionRegistrationMethod::kNormal ? 0.0 : o.first_beta;
  options.gate0_m = options.gate1_m = o.first_gate * o.voxel_m;
  options.iterations = o.iterations;
  options.neighbors = o.neighbors;
  options.min_matches = static_cast<std::size_t>(o.min_matches);
  options.min_overlap = o.min_overlap;
  if (!is_robust) return options;
  options.beta1 = o.last_beta;
  options.gate0_m = std::max(options.gate0_m, o.first_gate_sigmas * sigma_m);
  options.gate1_m = o.last_gate * o.voxel_m;
  options.annealed_iterations = o.annealed_iterations;
  options.kernel_width = o.kernel_width;
  options.crop_cell = o.crop_cell;
  return options;
}

/// How well the session's points lie on the LiDAR's, whatever moved them there.
void measure_fit(const PointCloud& session, const Bvh& lidar, const RegistrationOptions& options,
                 SessionRegistration& result) {
  const PointCloud thinned = voxel_thinned(session, options.voxel_m);
  const NearestField nearest = find_nearest(lidar, sort_points(thinned));
  const double sq_gate_m2 = sq_match_gate_m2(options);
  double sum_m2 = 0.0;
  for (const double sq_dist : nearest.sq_dist) {
    if (!(sq_dist <= sq_gate_m2)) continue;
    sum_m2 += sq_dist;
    ++result.n_matches;
  }
  result.overlap = static_cast<double>(result.n_matches) / static_cast<double>(thinned.size());
  result.rmse_m = result.n_matches > 0 ? std::sqrt(sum_m2 / static_cast<double>(result.n_matches)) : 0.0;
}

SessionRegistration kept(const Similarity& T_world_session, std::string why) {
  SessionRegistration result;
  result.T_world_session = T_world_session;
  result.accepted = false;
  result.flags.push_back(std::move(why));
  return result;
}

/// Without a measure of the fit.
SessionRegistration moved_session(const SessionCloud& session, const PointCloud& lidar,
                                  const Similarity& T_world_session, const RegistrationOptions& options,
                                  double sigma_m) {
  const bool with_weights = options.method == SessionRegistrationMethod::kRobust;
  try {
    const Sim3Alignment found =
        sim3_icp(session.cloud, lidar, Eigen::Matrix4d::Identity(), icp_options(options, sigma_m),
                 with_weights ? std::span<const float>(session.confidence) : std::span<const float>{});
    SessionRegistration result;
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

/// Mean of the squared distances, those beyond the gate of a match counted as at it.
double truncated_cost_m2(const SessionRegistration& result, const RegistrationOptions& options) {
  return result.overlap * result.rmse_m * result.rmse_m + (1.0 - result.overlap) * sq_match_gate_m2(options);
}

}  // namespace

SessionRegistration register_session(const SessionCloud& session, const PointCloud& lidar,
                                     const Similarity& T_world_session, const RegistrationOptions& options,
                                     double sigma_m) {
  if (session.cloud.positions.empty()) return kept(T_world_session, "the session has no points");
  if (lidar.positions.empty()) return kept(T_world_session, "the LiDAR has no points at the session's time");
  const Bvh target(sort_points(lidar));
  SessionRegistration before;
  before.T_world_session = T_world_session;
  measure_fit(session.cloud, target, options, before);
  if (options.method == SessionRegistrationMethod::kPrefusion) return before;
  SessionRegistration result = moved_session(session, lidar, T_world_session, options, sigma_m);
  const Similarity step = result.T_world_session * T_world_session.inverse();
  measure_fit(transformed(session.cloud, step.matrix()), target, options, result);
  const bool is_better = truncated_cost_m2(result, options) < truncated_cost_m2(before, options);
  if (options.method != SessionRegistrationMethod::kRobust || !result.accepted || is_better) return result;
  before.accepted = false;
  before.flags.push_back("registration fits no better than pre-fusion, which is kept");
  return before;
}

}  // namespace cmap
