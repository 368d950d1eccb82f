#include "simd/kernels.hpp"

namespace cmap {

namespace plain {
extern const MetricKernels kMetricKernels;
}
#if defined(__x86_64__)
namespace avx2 {
extern const MetricKernels kMetricKernels;
}
namespace avx512 {
extern const MetricKernels kMetricKernels;
}
#endif

const MetricKernels& metric_kernels_for(SimdLevel level) {
  switch (level) {
#if defined(__x86_64__)
    case SimdLevel::kAvx2:
      return avx2::kMetricKernels;
    case SimdLevel::kAvx512:
      return avx512::kMetricKernels;
#endif
    default:
      return plain::kMetricKernels;
  }
}

const MetricKernels& metric_kernels() { return metric_kernels_for(simd_level()); }

}  // namespace cmap
