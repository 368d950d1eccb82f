#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/byte_source.hpp"

namespace cmap {

/// How the faces of a mesh look.
struct MeshMaterial {
  RgbF diffuse{0.6F, 0.6F, 0.6F};
  std::filesystem::path image;  ///< empty: none
};

/// A triangle mesh as a file holds it. Polygons are split into fans.
struct MeshFile {
  std::vector<Eigen::Vector3d> vertices;                ///< m
  std::vector<RgbF> colors;                             ///< of the vertices, [0,1]; empty: none
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertices, in range
  std::vector<MeshMaterial> materials;                  ///< OBJ; empty: none
  std::vector<std::uint32_t> material_of;               ///< of every triangle; empty without materials
  std::vector<std::array<Eigen::Vector2f, 3>> uv;       ///< of every triangle's corners, v up; empty: no images
};

/// Throw InputError naming file, line (byte in binary data) and reason: malformed or truncated, an index that no vertex
/// has, a face of fewer than three corners, a coordinate that is not finite or beyond kMaxCoordinate_m.
MeshFile read_ply_mesh(ByteSource& source);
MeshFile read_obj_mesh(ByteSource& source, const std::filesystem::path& folder);

/// Whether a vertex can be used.
bool is_usable(const Eigen::Vector3d& vertex);

}  // namespace cmap
