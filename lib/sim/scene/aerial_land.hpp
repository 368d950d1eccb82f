#pragma once

#include <vector>

#include "scene/scene_builder.hpp"
#include "sensors/noise.hpp"

namespace cmap {

enum class LandUse { kCrop, kMeadow, kWood };

/// A rectangle of land, edges on multiples of Land::kCell_m.
struct FarmField {
  float x0, x1, y0, y1;  ///< m
  LandUse use;
};

/// Hills with a straight road along x, a river that winds along it on the other side, and fields in between.
class Land {
 public:
  Land(const AerialOptions& options, SceneRandom& random);

  static constexpr float kCell_m = 2.5F;
  static constexpr float kRoadHalf_m = 3.4F, kRiverHalf_m = 9.0F;

  float half_x, half_y;  ///< half the strip's size, m
  float road_y;          ///< center line
  float water_z;
  std::vector<FarmField> fields;

  float height(float x, float y) const;
  float river_y(float x) const;
  bool is_dry(float x, float y, float clearance) const;

 private:
  float hills(float x, float y) const;
  void divide(SceneRandom& random);

  float relief_;
  std::uint32_t seed_;
};

/// Ground, road, tracks and water.
void add_land(SceneBuilder& builder, SceneRandom& random, const Land& land);

}  // namespace cmap
