#include "simd/lanes_avx2.hpp"

#define CMAP_LANES avx2
#include "simd/kernels.inl"
