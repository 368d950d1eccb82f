#define CMAP_LANES avx2
#include "simd/kernels.inl"
