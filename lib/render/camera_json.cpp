#include "camera_json.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

using Json = nlohmann::ordered_json;

double camera_number(const std::string& key, const Json& value, double above, double below) {
  if (!value.is_number()) throw UsageError(fmt::format("{}: {} is not a number", key, value.dump()));
  const double v = value.get<double>();
  if (!(v > above && v < below))
    throw UsageError(fmt::format("{}: {} must lie between {} and {}", key, v, above, below));
  return v;
}

Eigen::VectorXd camera_numbers(const std::string& key, const Json& value, Eigen::Index n) {
  if (!value.is_array() || value.size() != static_cast<std::size_t>(n)) {
    throw UsageError(fmt::format("{}: expected {}", key, n == 3 ? "[x, y, z]" : fmt::format("{} numbers", n)));
  }
  Eigen::VectorXd numbers(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    numbers[i] = camera_number(key, value[static_cast<std::size_t>(i)], -kMaxCoordinate_m, kMaxCoordinate_m);
  }
  return numbers;
}

const Json& camera_member(const Json& object, const char* key) {
  if (!object.is_object() || !object.contains(key)) throw UsageError(fmt::format("{} is missing", key));
  return object.at(key);
}

}  // namespace cmap
