#include "simd/lanes_avx512.hpp"

#define CMAP_LANES avx512
#include "simd/kernels.inl"
