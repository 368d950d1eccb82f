#include "scene/textures.hpp"

namespace cmap {

RgbF texture_color(const Surface& s, const Eigen::Vector3f& p) {
  switch (s.material) {
    case Material::kPlain:
      return plain_texture(s, p);
    case Material::kBrick:
      return brick_texture(s, p);
    case Material::kPlaster:
      return plaster_texture(s, p);
    case Material::kPaint:
      return paint_texture(s, p);
    case Material::kStone:
      return stone_texture(s, p);
    case Material::kWindow:
      return window_texture(s, p);
    case Material::kDoor:
      return door_texture(s, p);
    case Material::kRoofTiles:
      return roof_texture(s, p);
    case Material::kAsphalt:
      return asphalt_texture(s, p);
    case Material::kPaving:
      return paving_texture(s, p);
    case Material::kGrass:
      return grass_texture(s, p);
    case Material::kGravel:
      return gravel_texture(s, p);
    case Material::kLeaves:
      return leaves_texture(s, p);
    case Material::kBark:
      return bark_texture(s, p);
    case Material::kCarPaint:
      return car_paint_texture(s, p);
    case Material::kMetal:
      return metal_texture(s, p);
    case Material::kWood:
      return wood_texture(s, p);
    case Material::kCarpet:
      return carpet_texture(s, p);
    case Material::kFloorTiles:
      return floor_tiles_texture(s, p);
    case Material::kCeiling:
      return ceiling_texture(s, p);
    case Material::kPicture:
      return picture_texture(s, p);
    case Material::kBooks:
      return books_texture(s, p);
    case Material::kScreen:
      return screen_texture(s, p);
    case Material::kFabric:
      return fabric_texture(s, p);
    case Material::kCrop:
      return crop_texture(s, p);
    case Material::kWater:
      return water_texture(s, p);
  }
  return s.base;
}

namespace {

/// Typical values near 905 nm: plants reflect much more there than in visible light, asphalt and rubber little.
float base_reflectivity(Material material) {
  switch (material) {
    case Material::kWater:
      return 0.0F;
    case Material::kAsphalt:
      return 0.12F;
    case Material::kWindow:
    case Material::kScreen:
      return 0.08F;
    case Material::kGrass:
    case Material::kLeaves:
    case Material::kCrop:
      return 0.55F;
    case Material::kBark:
    case Material::kRoofTiles:
    case Material::kCarpet:
    case Material::kBooks:
    case Material::kFabric:
    case Material::kWood:
      return 0.32F;
    case Material::kMetal:
    case Material::kCarPaint:
      return 0.25F;
    case Material::kPlaster:
    case Material::kPaint:
    case Material::kCeiling:
    case Material::kPicture:
      return 0.65F;
    default:
      return 0.42F;
  }
}

}  // namespace

float reflectivity(const Surface& surface, const Eigen::Vector3f& point) {
  return base_reflectivity(surface.material) * varied(value_noise(Eigen::Vector3f(3.0F * point), surface.seed), 0.25F);
}

}  // namespace cmap
