#pragma once

#include <vector>

#include "scene/scene_builder.hpp"

namespace cmap {

/// Where the streets of a town run, and how high its ground is. Centered on the origin.
class TownLayout {
 public:
  explicit TownLayout(const TownOptions& options);

  static constexpr float kSidewalk_m = 2.4F, kCurb_m = 0.12F;
  /// Meadows around the outermost blocks.
  static constexpr float kMargin_m = 24.0F;

  float block_x, block_y, street;           ///< m
  std::vector<float> streets_x, streets_y;  ///< x (y) of the center lines of streets along y (x)
  float half_x, half_y;                     ///< half the size, margin included, m

  /// Without curbs: of the road.
  float road_height(float x, float y) const;
  float road_half_width() const { return 0.5F * street - kSidewalk_m; }
  /// Lower left corner of block (i, j), i from 0 along x.
  Eigen::Vector2f block_corner(int i, int j) const;

 private:
  float undulation_;
  std::uint32_t seed_;
};

/// Roads with markings, curbs, sidewalks, and the grass inside and around the blocks.
void add_town_ground(SceneBuilder& builder, const TownLayout& layout, std::uint32_t seed);

}  // namespace cmap
