#pragma once

#include <cstdint>

#include "cmap/core/array.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "scene/scene_data.hpp"

namespace cmap {

/// Points of surfaces, relative to the scene's origin.
struct SurfaceSamples {
  Array<Eigen::Vector3f> positions;
  Array<std::uint32_t> triangles;
};

/// Uniform over the area, neighbors in the mesh beside each other; see sample_surface().
SurfaceSamples draw_samples(const SceneData& scene, double points_per_m2, std::uint64_t seed);

/// The samples with their colors.
PointCloud colored(const SceneData& scene, SurfaceSamples samples);

}  // namespace cmap
