#include "sim/noise.hpp"
#include "sim/surface.hpp"

namespace cmap {

RgbF texture_color(const Surface& surface, const Eigen::Vector3f& point, const Eigen::Vector3f&) {
  const float n = 0.5F + fractal_noise(Eigen::Vector3f(2.0F * point), 5, surface.seed);
  return {surface.base[0] * n, surface.base[1] * n, surface.base[2] * n};
}

float reflectivity(const Surface& surface, const Eigen::Vector3f&) {
  return surface.material == Material::kWater ? 0.0F : 0.4F;
}

}  // namespace cmap
