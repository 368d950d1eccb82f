#pragma once

#include <Eigen/Core>
#include <string>

namespace cmap {

/// A direction for people: "(0.00, 0.71, 0.71)"; of the two signs the one whose largest component is positive.
std::string direction_text(const Eigen::Vector3d& direction);

}  // namespace cmap
