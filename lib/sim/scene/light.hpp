#pragma once

#include <optional>

#include "scene/ray_caster.hpp"
#include "scene/surface.hpp"

namespace cmap {

/// The ray from a point to the sun; none where the surface faces away from it.
std::optional<Ray> sun_ray(const Surface& surface, const Eigen::Vector3f& point, const Eigen::Vector3f& normal);

/// A surface's color with light on it. Lambert's law, in display-referred values.
RgbF lit(const RgbF& texture, Lighting lighting, const Surface& surface, const Eigen::Vector3f& point,
         const Eigen::Vector3f& normal, bool in_shadow);

/// Gradient from horizon to zenith, with clouds. Unit direction.
RgbF sky_color(const Eigen::Vector3f& direction);

}  // namespace cmap
