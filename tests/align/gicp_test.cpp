#include "align/align_testing.hpp"
#include "align/towns.hpp"
#include "cmap/align/align.hpp"

namespace cmap {
namespace gicp_test {

/// Of two samples of the same surfaces no point meets its like: matches of points pull along the surface, those of
/// planes hardly.
TEST(Gicp, IsNearerThanPointsOnOtherSamplesOfASurface) {
  const PointCloud target = test::town(40, 30000, 1), source = test::town(40, 30000, 2);
  const Similarity T{1.0, rotation_from({0.002, -0.003, 0.01}), {0.2, -0.3, 0.1}};
  const PointCloud moved = transformed(source, T.inverse().matrix());
  const auto error_m = [&](const char* method) {
    const Alignment found = registration_method(method).run(moved, target, {}, 0.5);
    return test::displacement_m(similarity_from(found.T_dst_src), T, moved);
  };
  EXPECT_LT(error_m("gicp"), 0.5 * error_m("icp"));
}

}  // namespace gicp_test
}  // namespace cmap
