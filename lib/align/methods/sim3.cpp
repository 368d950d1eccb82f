#include <algorithm>

#include "cmap/align/align.hpp"
#include "cmap/align/icp.hpp"
#include "cmap/align/sim3_icp.hpp"
#include "cmap/core/error.hpp"

namespace cmap {
namespace {

/// On surfaces, point-to-point matches slide by a fraction of the points' spacing an iteration; planes settle at once.
Alignment settle_on_surfaces(const PointCloud& source, const PointCloud& target, const Sim3Alignment& found) {
  IcpOptions planes;
  planes.with_scale = true;
  planes.levels = {{found.voxel_m, found.max_distance_m, 50}};
  Alignment result = icp(source, target, found.T_dst_src, planes);
  result.method = found.method;
  result.iterations += found.iterations;
  result.warnings.insert(result.warnings.end(), found.warnings.begin(), found.warnings.end());
  return result;
}

Alignment run_sim3(const PointCloud& source, const PointCloud& target, const AlignOptions& options, double voxel_m) {
  Sim3IcpOptions sim3 = Sim3IcpOptions::robust(voxel_m);
  if (options.max_distance_m) {
    sim3.gate0_m = *options.max_distance_m;
    sim3.gate1_m = std::min(sim3.gate1_m, sim3.gate0_m);
  }
  const Sim3Alignment result = sim3_icp(source, target, options.T_initial, sim3);
  if (!result.accepted) {
    // Whoever asks for an alignment has no use for the start.
    const std::string why = result.warnings.empty() ? "no alignment was found" : result.warnings.back();
    const std::size_t colon = why.find(": ");
    throw UnsupportedError(colon == why.npos ? why : why.substr(colon + 2));
  }
  return settle_on_surfaces(source, target, result);
}

}  // namespace

namespace registration {

/// The paper's regularized ICP (sim3_icp.hpp), settled point to plane with scale.
extern constinit const RegistrationMethod sim3{.name = "sim3",
                                               .summary = "with scale, held near the start's at first",
                                               .scale = ScaleRule::kAlways,
                                               .run = run_sim3};

}  // namespace registration
}  // namespace cmap
