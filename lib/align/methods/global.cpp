#include "cmap/align/global.hpp"

#include "cmap/align/align.hpp"

namespace cmap::registration {

extern constinit const RegistrationMethod global{
    .name = "global",
    .summary = "from no start",
    .needs_initial = false,
    .takes_max_distance = false,
    .run = [](const PointCloud& source, const PointCloud& target, const AlignOptions& options, double voxel_m) {
      GlobalOptions how;
      how.with_scale = options.with_scale;
      how.fine_voxel_m = voxel_m;
      return global_registration(source, target, how);
    }};

}  // namespace cmap::registration
