// The kernels, compiled once for each instruction set: CMAP_LANES names the namespace that holds its lanes.
//
// No inline function of another header may be emitted here and then be shared with the rest of the program: it would
// carry this file's instructions onto processors without them. Hence plain loops and pointers in the kernels.

#include "simd/kernels.hpp"

// In order of use.
// clang-format off
#include "simd/hilbert.inl"
#include "simd/traversal.inl"
#include "simd/nearest.inl"
#include "simd/k_nearest.inl"
#include "simd/color_within.inl"
#include "simd/neighborhood.inl"
// clang-format on

namespace cmap::CMAP_LANES {

extern const Kernels kKernels;
const Kernels kKernels{&hilbert_keys, &nearest, &k_nearest, &most_similar_color, &neighborhood_shapes};

}  // namespace cmap::CMAP_LANES
