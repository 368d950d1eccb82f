#include "trajectory/residual_correlation.hpp"

#include <Eigen/Core>
#include <vector>

namespace cmap {

double alike_in_a_row(std::span<const PosePair> pairs, const Similarity& T) {
  std::vector<Eigen::Vector3d> residuals;
  double sum_sq = 0.0;
  for (const PosePair& pair : pairs) {
    residuals.emplace_back(T * pair.source.position - pair.target.position);
    sum_sq += residuals.back().squaredNorm();
  }
  double alike = 1.0;
  if (!(sum_sq > 0.0)) return alike;
  for (std::size_t lag = 1; 4 * lag <= residuals.size(); ++lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < residuals.size(); ++i) product += residuals[i].dot(residuals[i - lag]);
    if (!(product > 0.0)) break;
    alike += 2.0 * product / sum_sq;
  }
  return alike;
}

}  // namespace cmap
