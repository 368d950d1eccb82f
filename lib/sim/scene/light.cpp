#include "scene/light.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/noise.hpp"

namespace cmap {
namespace {

const Eigen::Vector3f kSun = Eigen::Vector3f(0.48F, -0.52F, 0.78F).normalized();
constexpr float kNoSurface_m = 1000.0F;
/// Off the surface, so that it does not shadow itself: more than positions are off, less than anything that is built.
constexpr float kLift_m = 2e-3F;

/// Leaves are lit as the crown that they belong to, from both sides.
Eigen::Vector3f lit_normal(const Surface& surface, const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  if (surface.material != Material::kLeaves) return normal;
  const Eigen::Vector3f outward = point - surface.origin;
  const Eigen::Vector3f facing = normal.dot(outward) < 0.0F ? Eigen::Vector3f(-normal) : normal;
  return (outward.normalized() + 0.45F * facing).normalized();
}

RgbF scaled(const RgbF& color, float r, float g, float b) {
  return {std::clamp(color[0] * r, 0.0F, 1.0F), std::clamp(color[1] * g, 0.0F, 1.0F),
          std::clamp(color[2] * b, 0.0F, 1.0F)};
}

RgbF lit_by_sun(const RgbF& texture, const Eigen::Vector3f& normal, bool in_shadow) {
  const float sun = in_shadow ? 0.0F : 0.72F * std::max(0.0F, normal.dot(kSun));
  const float sky = 0.46F + 0.12F * normal.z();
  // Sunlight is warm, the sky blue.
  return scaled(texture, 1.04F * sun + 0.95F * sky, sun + sky, 0.92F * sun + 1.08F * sky);
}

RgbF lit_in_room(const RgbF& texture, const Eigen::Vector3f& p, const Eigen::Vector3f& normal) {
  const float lamps = 0.07F * (value_noise(0.35F * p.x(), 0.35F * p.y(), 77) - 0.5F);
  const float low = 0.10F * smooth_step(0.5F, 0.0F, p.z()) * (1.0F - std::abs(normal.z()));  // corners are darker
  const float shade = 0.84F + 0.10F * normal.z() + 0.08F * normal.x() + 0.05F * normal.y() + lamps - low;
  return scaled(texture, 1.02F * shade, shade, 0.97F * shade);
}

}  // namespace

std::optional<Ray> sun_ray(const Surface& surface, const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  if (lit_normal(surface, point, normal).dot(kSun) <= 0.0F) return std::nullopt;
  const Eigen::Vector3f sunny_side = normal.dot(kSun) < 0.0F ? Eigen::Vector3f(-normal) : normal;
  return Ray{point + kLift_m * sunny_side, kSun, kNoSurface_m};
}

RgbF lit(const RgbF& texture, Lighting lighting, const Surface& surface, const Eigen::Vector3f& point,
         const Eigen::Vector3f& normal, bool in_shadow) {
  switch (lighting) {
    case Lighting::kSun:
      return lit_by_sun(texture, lit_normal(surface, point, normal), in_shadow);
    case Lighting::kRoom:
      return lit_in_room(texture, point, normal);
    case Lighting::kNone:
      break;
  }
  return scaled(texture, 1.0F, 1.0F, 1.0F);
}

RgbF sky_color(const Eigen::Vector3f& direction) {
  const float up = std::max(0.0F, direction.z());
  const float zenith = std::pow(up, 0.55F);
  const RgbF clear = {lerp(0.80F, 0.30F, zenith), lerp(0.87F, 0.52F, zenith), lerp(0.94F, 0.84F, zenith)};
  // A layer of clouds in a plane above.
  const float height = 1.0F / (up + 0.12F);
  const float density = fractal_noise(1.3F * direction.x() * height, 1.3F * direction.y() * height, 5, 4711);
  const float cloud = smooth_step(0.48F, 0.72F, density) * smooth_step(0.0F, 0.15F, up);
  const float white = 0.96F - 0.12F * smooth_step(0.60F, 0.85F, density);
  return {lerp(clear[0], white, cloud), lerp(clear[1], white, cloud), lerp(clear[2], white, cloud)};
}

}  // namespace cmap
