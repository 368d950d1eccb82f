#include "simd/lanes_sse2.hpp"

#define CMAP_LANES sse2
#include "simd/kernels.inl"
