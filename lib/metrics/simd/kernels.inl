// The kernels, compiled once for each instruction set: loops over lanes that the compiler turns into vectors, with
// operations that round alike in all of them. CMAP_LANES names the namespace.
//
// No inline function of another header may be emitted here and then be shared with the rest of the program: it would
// carry this file's instructions onto processors without them.

#include "simd/kernels.hpp"

// clang-format off
#include "simd/color_distances.inl"
#include "simd/grid_places.inl"
#include "simd/near_sums.inl"
// clang-format on

namespace cmap::CMAP_LANES {

extern const MetricKernels kMetricKernels;
const MetricKernels kMetricKernels{&grid_places, &offsets, &color_distances, &near_sums};

}  // namespace cmap::CMAP_LANES
