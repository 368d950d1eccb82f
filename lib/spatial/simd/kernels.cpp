#include "simd/kernels.hpp"

namespace cmap {

namespace plain {
extern const Kernels kKernels;
}
#if defined(__x86_64__)
namespace sse2 {
extern const Kernels kKernels;
}
namespace avx2 {
extern const Kernels kKernels;
}
namespace avx512 {
extern const Kernels kKernels;
}
#endif

const Kernels& kernels_for(SimdLevel level) {
  switch (level) {
#if defined(__x86_64__)
    case SimdLevel::kSse2:
      return sse2::kKernels;
    case SimdLevel::kAvx2:
      return avx2::kKernels;
    case SimdLevel::kAvx512:
      return avx512::kKernels;
#endif
    default:
      return plain::kKernels;
  }
}

const Kernels& kernels() { return kernels_for(simd_level()); }

}  // namespace cmap
