#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// What a surface is made of: selects its texture.
enum class Material : std::uint8_t {
  kPlain,  ///< painted, slightly stained
  kBrick,
  kPlaster,
  kPaint,   ///< of an inner wall
  kStone,   ///< large blocks
  kWindow,  ///< glass (accent) in a frame (base)
  kDoor,
  kRoofTiles,
  kAsphalt,
  kPaving,  ///< slabs
  kGrass,
  kGravel,
  kLeaves,
  kBark,
  kCarPaint,
  kMetal,
  kWood,
  kCarpet,
  kFloorTiles,
  kCeiling,
  kPicture,  ///< a poster or painting that fills the surface
  kBooks,
  kScreen,
  kFabric,
  kCrop,  ///< rows of plants
  kWater,
};

/// How surfaces are lit; baked into their colors, so that they do not depend on the view.
enum class Lighting {
  kSun,   ///< a sun that casts shadows, and the sky
  kRoom,  ///< lamps in the ceiling
  kNone,  ///< colors as they are
};

/// A texture and where it lies. Positions are relative to the scene's origin.
struct Surface {
  Material material = Material::kPlain;
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();  ///< (u, v) = (0, 0); of leaves: the crown's center
  Eigen::Vector3f u_axis = Eigen::Vector3f::UnitX(), v_axis = Eigen::Vector3f::UnitY();  ///< unit, in the surface
  float width = 1.0F, height = 1.0F;  ///< of the patch that kWindow, kDoor, kPicture fill, m
  RgbF base{0.6F, 0.6F, 0.6F}, accent{0.4F, 0.4F, 0.4F};
  std::uint32_t seed = 0;
};

/// Reflectance of the surface in [0,1] before light falls on it.
RgbF texture_color(const Surface& surface, const Eigen::Vector3f& point);

/// Of near infrared light, 0 for water.
float reflectivity(const Surface& surface, const Eigen::Vector3f& point);

}  // namespace cmap
