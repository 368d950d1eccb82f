#include "cmap/recon/session_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cmap/align/icp.hpp"
#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "sessions/shared_frames.hpp"

namespace cmap {
namespace {

Eigen::Vector3d world_point(const PlacedSession& placed, std::size_t frame, const Eigen::Vector3f& point) {
  return placed.T_world_camera[frame] * (placed.scale * point.cast<double>());
}

/// World points of the same pixels by both sessions.
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

/// At most so many stay, evenly chosen.
void thin_out(std::size_t max_pixels, PixelPairs& pairs) {
  const std::size_t step = (pairs.a.size() + max_pixels - 1) / max_pixels;
  if (step <= 1) return;
  std::size_t n = 0;
  for (std::size_t i = 0; i < pairs.a.size(); i += step, ++n) {
    pairs.a[n] = pairs.a[i];
    pairs.b[n] = pairs.b[i];
  }
  pairs.a.resize(n);
  pairs.b.resize(n);
}

/// A rigid motion of b onto a, and how far apart the points then are.
struct FoundMotion {
  Similarity T;
  double distance_m = 0.0;
};

/// With Cauchy weights about the median distance.
FoundMotion motion_of(const PixelPairs& pairs, int rounds) {
  std::vector<double> weights(pairs.a.size(), 1.0), residuals(pairs.a.size());
  FoundMotion motion;
  for (int round = 0; round < rounds; ++round) {
    motion.T = umeyama(pairs.b, pairs.a, ScaleModel::rigid(), weights);
    for (std::size_t i = 0; i < pairs.a.size(); ++i) residuals[i] = (motion.T * pairs.b[i] - pairs.a[i]).norm();
    std::vector<double> values = residuals;
    motion.distance_m = median(values);
    const double width_m = std::max(motion.distance_m, 1e-6);
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

/// ICP of the shared frames' points from there; none where their geometry does not hold it.
std::optional<FoundMotion> refined(const PixelPairs& pairs, const FoundMotion& motion, double voxel_m,
                                   const LinkOptions& options) {
  IcpOptions icp_options;
  icp_options.metric = IcpMetric::kGicp;
  icp_options.kernel_width = options.kernel_width;
  icp_options.neighbors = options.neighbors;
  icp_options.levels = {
      {voxel_m, std::max(options.gate * voxel_m, options.gate * motion.distance_m), options.iterations}};
  const double thinned_m = options.thinning * voxel_m;
  try {
    const Alignment found =
        icp(cloud_of(pairs.b, thinned_m), cloud_of(pairs.a, thinned_m), motion.T.matrix(), icp_options);
    return FoundMotion{similarity_from(found.T_dst_src), found.rmse_m};
  } catch (const UnsupportedError&) {
    return std::nullopt;
  }
}

PixelPairs shared_pixels(const LinkedSession& a, const LinkedSession& b, std::span<const FramePair> shared,
                         PointSource source) {
  PixelPairs pairs;
  for (const FramePair& frame : shared) {
    add_frame_pairs(
        frame_points(a.predictions, frame.a, a.min_confidence, source),
        frame_points(b.predictions, frame.b, b.min_confidence, source),
        [&](const Eigen::Vector3f& p) { return world_point(a.placed, frame.a, p); },
        [&](const Eigen::Vector3f& p) { return world_point(b.placed, frame.b, p); }, pairs);
  }
  return pairs;
}

/// The link that a motion of b onto a makes of a frame of both.
SessionLink link_of(const FoundMotion& motion, const FramePair& frame, const LinkedSession& a, const LinkedSession& b) {
  Eigen::Isometry3d correction = Eigen::Isometry3d::Identity();
  correction.linear() = motion.T.rotation;
  correction.translation() = motion.T.translation;
  SessionLink link;
  link.from_frame = frame.a;
  link.to_frame = frame.b;
  link.T_from_to = a.placed.T_world_camera[frame.a].inverse() * correction * b.placed.T_world_camera[frame.b];
  link.rmse_m = motion.distance_m;
  return link;
}

}  // namespace

std::variant<SessionLink, NotLinked> link_sessions(const LinkedSession& a, const LinkedSession& b, PointSource source,
                                                   double same_frame_s, double voxel_m, const LinkOptions& options) {
  const std::vector<FramePair> shared = shared_frames(a.placed.time_s, b.placed.time_s, same_frame_s);
  if (shared.empty()) return NotLinked{"no frame is shared"};
  if (a.predictions.width != b.predictions.width || a.predictions.height != b.predictions.height) {
    return NotLinked{"the pictures have other sizes"};
  }
  PixelPairs pairs = shared_pixels(a, b, shared, source);
  thin_out(static_cast<std::size_t>(options.max_pixels), pairs);
  if (std::ssize(pairs.a) < options.min_pixels) {
    return NotLinked{fmt::format("{} pixels of shared frames are good in both", pairs.a.size())};
  }
  try {
    const FoundMotion by_pixels = motion_of(pairs, options.rounds);
    const std::optional<FoundMotion> by_icp = refined(pairs, by_pixels, voxel_m, options);
    SessionLink link = link_of(by_icp.value_or(by_pixels), shared[shared.size() / 2], a, b);
    link.n_points = pairs.a.size();
    link.refined = by_icp.has_value();
    return link;
  } catch (const UnsupportedError& error) {
    return NotLinked{error.what()};
  }
}

}  // namespace cmap
