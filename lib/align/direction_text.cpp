#include "direction_text.hpp"

#include <fmt/format.h>

namespace cmap {

std::string direction_text(const Eigen::Vector3d& direction) {
  Eigen::Index largest = 0;
  (void)direction.cwiseAbs().maxCoeff(&largest);
  Eigen::Vector3d d = direction.normalized();
  if (d[largest] < 0.0) d = -d;
  // No "-0.00".
  for (double& v : d.reshaped()) v = std::abs(v) < 0.005 ? 0.0 : v;
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", d.x(), d.y(), d.z());
}

}  // namespace cmap
