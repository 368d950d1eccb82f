#include "spatial/simd/lanes_plain.hpp"

#define CMAP_LANES plain
#include "spatial/simd/kernels.inl"
