#pragma once

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>

namespace cmap {

/// A number, or null where it is missing: NaN and infinity are not values.
inline nlohmann::ordered_json json_number(double v) {
  return std::isfinite(v) ? nlohmann::ordered_json(v) : nlohmann::ordered_json(nullptr);
}

inline nlohmann::ordered_json json_vector(const Eigen::Vector3d& v) {
  return {json_number(v.x()), json_number(v.y()), json_number(v.z())};
}

}  // namespace cmap
