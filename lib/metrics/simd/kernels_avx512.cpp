#define CMAP_LANES avx512
#include "simd/kernels.inl"
