#include "cmap/metrics/geometry.hpp"

#include <cmath>

namespace cmap {

Chamfer chamfer(const DistanceStats& e, const DistanceStats& r) {
  const double sum = e.mean_m + r.mean_m;
  return {sum, 0.5 * sum, e.mean_sq_m2 + r.mean_sq_m2, 0.5 * (std::sqrt(e.mean_sq_m2) + std::sqrt(r.mean_sq_m2)),
          e.mean_truncated_m + r.mean_truncated_m};
}

double f_score(double precision, double recall) {
  return precision + recall > 0.0 ? 2.0 * precision * recall / (precision + recall) : 0.0;
}

}  // namespace cmap
