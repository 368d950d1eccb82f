#include "last_steps.hpp"

#include "cmap/align/icp.hpp"
#include "cmap/core/error.hpp"

namespace cmap {

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

void sharpen(const PointCloud& source, const PointCloud& target, const RegistrationMethod& method, bool with_scale,
             double voxel_m, Alignment& found) {
  constexpr std::size_t kMostPoints = 100'000;
  constexpr double kWorthIt = 0.75;  // of the voxel so far
  if (voxel_m > kWorthIt * found.voxel_m) return;
  const bool is_own = method.needs_initial && method.scale == ScaleRule::kOnRequest;
  const RegistrationMethod& finer = is_own ? method : registration_method("gicp");
  try {
    AlignOptions how;
    how.T_initial = found.T_dst_src;
    how.with_scale = with_scale;
    how.most_points = kMostPoints;
    Alignment sharper = finer.run(source, target, how, voxel_m);
    const Similarity judged = similarity_from(found.T_dst_src), sharp = similarity_from(sharper.T_dst_src);
    if (farthest_apart(judged, sharp, corners(bounds(source))) > found.voxel_m) return;
    sharper.method = found.method;
    sharper.judgment = found.judgment;
    sharper.iterations += found.iterations;
    found = std::move(sharper);
  } catch (const UnsupportedError&) {
    // Too little lies so near to each other: what was found stands.
  }
}

}  // namespace cmap
