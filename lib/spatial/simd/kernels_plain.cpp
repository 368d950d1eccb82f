#include "simd/lanes_plain.hpp"

#define CMAP_LANES plain
#include "simd/kernels.inl"
