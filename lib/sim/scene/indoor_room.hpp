#pragma once

#include "scene/scene_builder.hpp"
#include "sensors/noise.hpp"

namespace cmap {

/// A room in the builder's frame: its door wall lies at y = 0 (the corridor's side) and is `kWall_m` thick, x and y run
/// inside, floor at z = 0.
struct Room {
  float width, depth, height;  ///< m, walls included
  float door_from, door_to;    ///< where along x the door may be
  bool has_windows;            ///< in the wall opposite to the door
};

inline constexpr float kWall_m = 0.14F;

/// Floor, walls, ceiling, door, windows, and the face of the door wall in the corridor.
void add_room(SceneBuilder& builder, SceneRandom& random, const Room& room, float furniture);

/// Furniture of an office, a meeting room or a lounge.
void furnish(SceneBuilder& builder, SceneRandom& random, const Room& room, float furniture);

/// Paintings, posters and notice boards side by side on a wall from u0 to u1. The plane starts at (start), u runs
/// along.
void hang_pictures(SceneBuilder& builder, SceneRandom& random, const Eigen::Vector3f& start,
                   const Eigen::Vector3f& along, float u0, float u1);

/// A plant in a pot.
void add_pot_plant(SceneBuilder& builder, SceneRandom& random, const Eigen::Vector3f& at);

}  // namespace cmap
