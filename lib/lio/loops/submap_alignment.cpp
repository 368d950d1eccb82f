#include "loops/submap_alignment.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/align/icp.hpp"
#include "cmap/core/error.hpp"
#include "loops/drift_bound.hpp"

namespace cmap {
namespace {

constexpr double kPatchVoxels = 2.5;                          ///< size of a patch of surface
constexpr double kToleranceVoxels = 0.5;                      ///< patches that agree are within this of each other
constexpr double kDistinctVoxels = 5.0, kDistinct_rad = 0.1;  ///< poses that differ by more are different answers

IcpOptions icp_options(const LoopOptions& options) {
  const double v = options.voxel_m;
  IcpOptions icp;
  icp.metric = IcpMetric::kPlane;
  icp.levels = {{4.0 * v, 10.0 * v, 30, 3000}, {2.0 * v, 5.0 * v, 20, 4000}, {v, 2.5 * v, 20, 6000}};
  return icp;
}

/// From one start; a judgment is not made yet, but for why ICP failed.
SubmapAlignment aligned_from(const SubmapSurface& from, const SubmapSurface& to, const Eigen::Isometry3d& start,
                             const LoopOptions& options) {
  SubmapAlignment result;
  try {
    const Alignment found = icp(to.points, from.points, start.matrix(), icp_options(options));
    result.T_from_to = Eigen::Isometry3d(found.T_dst_src);
    result.agreement = agreement_of(to.planes, from.planes, result.T_from_to, kToleranceVoxels * options.voxel_m);
    result.rmse_m = result.agreement.rmse_m;
    result.error_m = found.standard_errors.empty() ? 0.0 : found.standard_errors.front().standard_error_m;
    result.judgment.weak = found.standard_errors;
    result.is_aligned = true;
  } catch (const UnsupportedError& error) {
    result.judgment.verdict = Verdict::kUnsupported;
    result.judgment.reason = error.what();
  }
  return result;
}

bool are_apart(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const LoopOptions& options) {
  return !difference(a, b).within({kDistinctVoxels * options.voxel_m, kDistinct_rad});
}

void judge(SubmapAlignment& best, std::span<const SubmapAlignment> all, const LoopOptions& options) {
  const PatchAgreement& agreement = best.agreement;
  Judgment& judgment = best.judgment;
  std::erase_if(judgment.weak, [&](const WeakDirection& d) { return d.standard_error_m <= options.largest_error_m; });
  judgment.score = agreement.score;
  judgment.reason = fmt::format("beyond chance {:.0f} % of the surface that both show agrees, in {:.0f} places",
                                100.0 * agreement.score, agreement.places);
  for (const SubmapAlignment& other : all) {
    const bool is_rival = other.is_aligned && are_apart(best.T_from_to, other.T_from_to, options) &&
                          other.agreement.score >= options.rival_score_share * agreement.score;
    if (is_rival) judgment.rivals.push_back({other.T_from_to.matrix(), other.agreement.score});
  }
  if (agreement.score < options.least_score || agreement.places < options.least_places) {
    judgment.verdict = Verdict::kUnsupported;
  } else if (!judgment.rivals.empty()) {
    judgment.verdict = Verdict::kAmbiguous;
    judgment.reason += fmt::format("; another pose fits as well, by {:.0f} %", 100.0 * judgment.rivals.front().score);
  } else if (!judgment.weak.empty()) {
    judgment.verdict = Verdict::kWeak;
    judgment.reason += fmt::format("; uncertain by {:.2f} m in {}", judgment.weak.front().standard_error_m,
                                   judgment.weak.front().name);
  } else {
    judgment.verdict = Verdict::kDetermined;
  }
}

}  // namespace

SubmapSurface::SubmapSurface(PointCloud cloud, const LoopOptions& options)
    : points(std::move(cloud)), planes(points, kPatchVoxels * options.voxel_m) {}

SubmapAlignment align_submaps(const SubmapSurface& from, const SubmapSurface& to,
                              std::span<const Eigen::Isometry3d> starts, const LoopOptions& options) {
  std::vector<SubmapAlignment> all;
  for (const Eigen::Isometry3d& start : starts) {
    // It would end where another one did.
    const bool is_known = std::any_of(all.begin(), all.end(), [&](const SubmapAlignment& a) {
      return a.is_aligned && a.agreement.score >= options.least_score && !are_apart(a.T_from_to, start, options);
    });
    if (!is_known) all.push_back(aligned_from(from, to, start, options));
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i].is_aligned && (!all[best].is_aligned || all[i].agreement.score > all[best].agreement.score)) best = i;
  }
  SubmapAlignment result = all.at(best);
  if (result.is_aligned) judge(result, all, options);
  return result;
}

}  // namespace cmap
