#pragma once

#include "scene/scene_builder.hpp"
#include "sensors/noise.hpp"

namespace cmap {

/// A rectangle in a wall: u to the right seen from outside, v up.
struct WallRect {
  float u0, u1, v0, v1;
};

/// A vertical wall plane in the builder's frame: `along` is to the right seen from outside.
struct WallPlane {
  Eigen::Vector3f start, along;

  Eigen::Vector3f outward() const { return along.cross(Eigen::Vector3f::UnitZ()); }
  /// `out` meters in front of the wall.
  Eigen::Vector3f at(float u, float v, float out = 0.0F) const {
    return start + u * along + v * Eigen::Vector3f::UnitZ() + out * outward();
  }
};

/// The texture of `look` on a wall.
Surface on_wall(const WallPlane& wall, Surface look);

/// A flat patch `out` meters in front of the wall.
void add_panel(SceneBuilder& builder, const WallPlane& wall, const WallRect& rect, float out, Surface look);

/// A box that stands out from the wall.
void add_ledge(SceneBuilder& builder, const WallPlane& wall, const WallRect& rect, float out, Surface look);

/// A cell of a wall around an opening, `fill` lying `recess_m` deep in it.
void add_opening(SceneBuilder& builder, std::uint32_t wall_surface, const WallPlane& wall, const WallRect& cell,
                 const WallRect& opening, float recess_m, Surface fill);

/// How a house looks.
struct HouseStyle {
  Surface wall, trim, roof, frame, door;
  int storeys = 2;
  float storey_m = 3.0F;
  bool has_shop = false, has_balconies = false, has_flat_roof = false;
};

HouseStyle random_house_style(SceneRandom& random, int storeys);

/// A house in the builder's frame: its front along x at y = 0, facing -y, `width` x `depth`, ground floor at z = 0.
void add_house(SceneBuilder& builder, SceneRandom& random, const HouseStyle& style, float width, float depth);

}  // namespace cmap
