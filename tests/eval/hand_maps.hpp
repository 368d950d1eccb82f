#pragma once

#include "eval/eval_testing.hpp"

// Small maps whose values are found by hand.
namespace cmap::test {

/// Values found by hand: distances 0.25 and 3 one way; 0.25, 3 and 5 the other.
inline const PointCloud kReference =
    small_map({{0, 0, 0}, {8, 0, 0}, {0, 5.25f, 0}}, {Rgb8{0, 0, 0}, Rgb8{0, 255, 0}, Rgb8{0, 0, 0}});
inline const PointCloud kEstimate = small_map({{0, 0.25f, 0}, {8, 3, 0}}, {Rgb8{0, 0, 0}, Rgb8{0, 0, 0}});

/// Two voxels of trace 0.02, as in the example of the authors' tool, and a lone point.
inline const std::vector<Eigen::Vector3f> kSpots{{0.01f, 0, 0}, {0.02f, 0, 0}, {1.01f, 0, 0}, {1.02f, 0, 0}, {5, 5, 5}};
inline const std::vector<Rgb8> kSpotColors{{0, 0, 0}, {51, 0, 0}, {0, 102, 0}, {0, 153, 0}, {9, 9, 9}};
inline const PointCloud kSpotMap = small_map(kSpots, kSpotColors);

}  // namespace cmap::test
