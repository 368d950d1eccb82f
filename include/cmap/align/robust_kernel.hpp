#pragma once

namespace cmap {

/// How far matches count in a registration; c is the kernel's width.
enum class RobustKernel {
  kNone,    ///< w = 1
  kHuber,   ///< w = min(1, c / r)
  kCauchy,  ///< w = 1 / (1 + (r / c)^2)
};

/// Weight of a residual r >= 0 in iteratively reweighted least squares.
inline double robust_weight(RobustKernel kernel, double r, double c) {
  switch (kernel) {
    case RobustKernel::kHuber:
      return r <= c ? 1.0 : c / r;
    case RobustKernel::kCauchy:
      return 1.0 / (1.0 + (r / c) * (r / c));
    default:
      return 1.0;
  }
}

}  // namespace cmap
