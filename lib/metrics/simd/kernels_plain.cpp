#define CMAP_LANES plain
#include "simd/kernels.inl"
