#pragma once

#include "scene/scene_builder.hpp"
#include "sensors/noise.hpp"

namespace cmap {

/// What stands around outside, each at the origin of the builder's frame, z = 0 on the ground.

/// Trunk, branches and a crown of leaves, facets of leaf_m that let some light through.
void add_tree(SceneBuilder& builder, SceneRandom& random, float height_m, float leaf_m, int leaves);
/// A conifer.
void add_fir(SceneBuilder& builder, SceneRandom& random, float height_m, int leaves);
/// Heading along x.
void add_car(SceneBuilder& builder, SceneRandom& random);
/// Its arm reaches along x.
void add_street_lamp(SceneBuilder& builder);
/// Seen from -y.
void add_bench(SceneBuilder& builder, SceneRandom& random);
void add_trash_bin(SceneBuilder& builder, SceneRandom& random);
/// A post with a sign that faces -y.
void add_sign(SceneBuilder& builder, SceneRandom& random);
/// Along x from 0 to length_m.
void add_hedge(SceneBuilder& builder, SceneRandom& random, float length_m, float height_m);

}  // namespace cmap
