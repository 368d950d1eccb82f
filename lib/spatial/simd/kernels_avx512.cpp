#include "spatial/simd/lanes_avx512.hpp"

#define CMAP_LANES avx512
#include "spatial/simd/kernels.inl"
