#include "methods/icp_method.hpp"

namespace cmap::registration {

extern constinit const RegistrationMethod icp{
    .name = "icp",
    .summary = "point to point",
    .run = [](const PointCloud& source, const PointCloud& target, const AlignOptions& options, double voxel_m) {
      return run_icp(source, target, options, voxel_m, IcpMetric::kPoint);
    }};

}  // namespace cmap::registration
