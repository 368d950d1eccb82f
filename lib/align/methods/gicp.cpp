#include "methods/icp_method.hpp"

namespace cmap::registration {

extern constinit const RegistrationMethod gicp{
    .name = "gicp",
    .summary = "plane to plane",
    .run = [](const PointCloud& source, const PointCloud& target, const AlignOptions& options, double voxel_m) {
      return run_icp(source, target, options, voxel_m, IcpMetric::kGicp);
    }};

}  // namespace cmap::registration
