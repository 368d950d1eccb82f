#include "methods/icp_method.hpp"

namespace cmap::registration {

extern constinit const RegistrationMethod plane{
    .name = "plane",
    .summary = "point to plane",
    .run = [](const PointCloud& source, const PointCloud& target, const AlignOptions& options, double voxel_m) {
      return run_icp(source, target, options, voxel_m, IcpMetric::kPlane);
    }};

}  // namespace cmap::registration
