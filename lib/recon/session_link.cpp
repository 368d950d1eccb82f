#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/align/icp.hpp"
#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/recon/session_graph.hpp"
#include "shared_frames.hpp"

namespace cmap {
namespace {

constexpr std::size_t kFewestSharedPixels = 100, kMostPixels = 40'000;

Eigen::Vector3d world_point(const PlacedSession& placed, std::size_t frame, const Eigen::Vector3f& point) {
  return placed.T_world_camera[frame] * (placed.scale * point.cast<double>());
}

/// World points of the same pixels by both sessions, at most kMostPixels, evenly chosen.
struct PixelPairs {
  std::vector<Eigen::Vector3d> a, b;
};

void add_frame_pairs(const FramePoints& a, const FramePoints& b, const auto& place_a, const auto& place_b,
                     PixelPairs& pairs) {
  for (std::size_t i = 0, j = 0; i < a.pixel.size() && j < b.pixel.size();) {
    if (a.pixel[i] == b.pixel[j]) {
      pairs.a.push_back(place_a(a.positions[i++]));
      pairs.b.push_back(place_b(b.positions[j++]));
    } else {
      a.pixel[i] < b.pixel[j] ? ++i : ++j;
    }
  }
}

void thin_out(PixelPairs& pairs) {
  const std::size_t step = (pairs.a.size() + kMostPixels - 1) / kMostPixels;
  if (step <= 1) return;
  std::size_t n = 0;
  for (std::size_t i = 0; i < pairs.a.size(); i += step, ++n) {
    pairs.a[n] = pairs.a[i];
    pairs.b[n] = pairs.b[i];
  }
  pairs.a.resize(n);
  pairs.b.resize(n);
}

/// The rigid motion of b onto a, with Cauchy weights about the median residual; and that median.
Similarity motion_of(const PixelPairs& pairs, double& median_m) {
  constexpr int kSteps = 10;
  std::vector<double> weights(pairs.a.size(), 1.0), residuals(pairs.a.size());
  Similarity motion;
  for (int step = 0; step < kSteps; ++step) {
    motion = umeyama(pairs.b, pairs.a, ScaleModel::rigid(), weights);
    for (std::size_t i = 0; i < pairs.a.size(); ++i) residuals[i] = (motion * pairs.b[i] - pairs.a[i]).norm();
    std::vector<double> values = residuals;
    median_m = median(values);
    const double width_m = std::max(median_m, 1e-6);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      weights[i] = robust_weight(RobustKernel::kCauchy, residuals[i], width_m);
    }
  }
  return motion;
}

PointCloud cloud_of(const std::vector<Eigen::Vector3d>& points, double voxel_m) {
  PointCloud cloud;
  cloud.origin = choose_origin({points.front(), points.front()});
  for (const Eigen::Vector3d& p : points) cloud.positions.push_back((p - cloud.origin).cast<float>());
  return voxel_thinned(cloud, voxel_m);
}

/// ICP of the shared frames' points from there; false where their geometry does not hold it.
bool refine(const PixelPairs& pairs, double voxel_m, double median_m, Similarity& motion, double& rmse_m) {
  IcpOptions options;
  options.metric = IcpMetric::kGicp;
  options.levels = {{voxel_m, std::max(3.0 * voxel_m, 3.0 * median_m), 30}};
  try {
    const Alignment found =
        icp(cloud_of(pairs.b, voxel_m / 2), cloud_of(pairs.a, voxel_m / 2), motion.matrix(), options);
    motion = similarity_from(found.T_dst_src);
    rmse_m = found.rmse_m;
    return true;
  } catch (const UnsupportedError&) {
    return false;
  }
}

}  // namespace

std::optional<SessionLink> link_sessions(const SessionPredictions& a, const PlacedSession& placed_a,
                                         double min_confidence_a, const SessionPredictions& b,
                                         const PlacedSession& placed_b, double min_confidence_b,
                                         const LinkOptions& options, std::string& reason) {
  const std::vector<FramePair> shared = shared_frames(placed_a.time_s, placed_b.time_s);
  if (shared.empty()) {
    reason = "no frame is shared";
    return std::nullopt;
  }
  if (a.width != b.width || a.height != b.height) {
    reason = "the pictures have other sizes";
    return std::nullopt;
  }
  PixelPairs pairs;
  for (const FramePair& frame : shared) {
    add_frame_pairs(
        frame_points(a, frame.a, min_confidence_a, options.source),
        frame_points(b, frame.b, min_confidence_b, options.source),
        [&](const Eigen::Vector3f& p) { return world_point(placed_a, frame.a, p); },
        [&](const Eigen::Vector3f& p) { return world_point(placed_b, frame.b, p); }, pairs);
  }
  thin_out(pairs);
  if (pairs.a.size() < kFewestSharedPixels) {
    reason = fmt::format("{} pixels of shared frames are good in both", pairs.a.size());
    return std::nullopt;
  }
  SessionLink link;
  link.n_points = pairs.a.size();
  Similarity motion;
  try {
    motion = motion_of(pairs, link.rmse_m);
  } catch (const UnsupportedError& error) {
    reason = error.what();
    return std::nullopt;
  }
  link.refined = refine(pairs, options.voxel_m, link.rmse_m, motion, link.rmse_m);
  const FramePair& middle = shared[shared.size() / 2];
  Eigen::Isometry3d correction = Eigen::Isometry3d::Identity();
  correction.linear() = motion.rotation;
  correction.translation() = motion.translation;
  link.from_frame = middle.a;
  link.to_frame = middle.b;
  link.T_from_to = placed_a.T_world_camera[middle.a].inverse() * correction * placed_b.T_world_camera[middle.b];
  return link;
}

}  // namespace cmap
