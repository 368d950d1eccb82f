#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/io/image_file.hpp"
#include "cmap/io/mesh_file.hpp"
#include "scene/scene_data.hpp"
#include "sensors/noise.hpp"

namespace cmap {
namespace {

/// What is needed to color a point of a triangle.
struct MeshColors {
  std::vector<Triangle> triangles;
  std::vector<Eigen::Vector3f> vertices;  ///< relative to the scene's origin
  std::vector<RgbF> colors;               ///< of the vertices; or:
  std::vector<std::uint32_t> material_of;
  std::vector<std::array<Eigen::Vector2f, 3>> uv;
  std::vector<MeshMaterial> materials;
  std::vector<RgbImage> images;  ///< of every material; without pixels: none
};

/// Weights of a triangle's corners at a point in its plane.
Eigen::Vector3f barycentric(const MeshColors& mesh, std::uint32_t triangle, const Eigen::Vector3f& point) {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3f a = mesh.vertices[t[0]], ab = mesh.vertices[t[1]] - a, ac = mesh.vertices[t[2]] - a;
  const Eigen::Vector3f n = ab.cross(ac), ap = point - a;
  const float area = std::max(n.squaredNorm(), 1e-30F);
  const float wb = std::clamp(ap.cross(ac).dot(n) / area, 0.0F, 1.0F);
  const float wc = std::clamp(ab.cross(ap).dot(n) / area, 0.0F, 1.0F - wb);
  return {1.0F - wb - wc, wb, wc};
}

RgbF texel(const RgbImage& image, int x, int y) {
  // Beyond the image it repeats, as renderers do.
  const int px = ((x % image.width) + image.width) % image.width,
            py = ((y % image.height) + image.height) % image.height;
  const Rgb8& bytes = image.at(px, py);
  return {static_cast<float>(bytes[0]) / 255.0F, static_cast<float>(bytes[1]) / 255.0F,
          static_cast<float>(bytes[2]) / 255.0F};
}

RgbF sampled(const RgbImage& image, const Eigen::Vector2f& uv) {
  const float x = (uv.x() - std::floor(uv.x())) * static_cast<float>(image.width) - 0.5F;
  const float y = (1.0F - (uv.y() - std::floor(uv.y()))) * static_cast<float>(image.height) - 0.5F;
  const int ix = floor_int(x), iy = floor_int(y);
  const float tx = fraction(x), ty = fraction(y);
  RgbF result;
  for (std::size_t c = 0; c < 3; ++c) {
    result[c] = lerp(lerp(texel(image, ix, iy)[c], texel(image, ix + 1, iy)[c], tx),
                     lerp(texel(image, ix, iy + 1)[c], texel(image, ix + 1, iy + 1)[c], tx), ty);
  }
  return result;
}

RgbF mesh_color(const MeshColors& mesh, std::uint32_t triangle, const Eigen::Vector3f& point) {
  const Eigen::Vector3f w = barycentric(mesh, triangle, point);
  if (!mesh.colors.empty()) {
    const Triangle& t = mesh.triangles[triangle];
    RgbF result;
    for (std::size_t c = 0; c < 3; ++c) {
      result[c] = w[0] * mesh.colors[t[0]][c] + w[1] * mesh.colors[t[1]][c] + w[2] * mesh.colors[t[2]][c];
    }
    return result;
  }
  const std::uint32_t material = mesh.material_of[triangle];
  if (mesh.images[material].pixels.empty()) return mesh.materials[material].diffuse;
  const auto& uv = mesh.uv[triangle];
  return sampled(mesh.images[material], w[0] * uv[0] + w[1] * uv[1] + w[2] * uv[2]);
}

MeshFile read_mesh(const std::filesystem::path& path) {
  const std::string extension = lower_case(path.extension().string());
  ByteSource source(path);
  if (extension == ".ply") return read_ply_mesh(source);
  if (extension == ".obj") return read_obj_mesh(source, path.parent_path());
  throw UsageError(fmt::format("{}: a mesh is a .ply or an .obj file", path.string()));
}

/// Whether the file itself says what color anything has.
bool has_own_colors(const MeshFile& file) { return !file.colors.empty() || file.materials.size() > 1; }

MeshColors colors_of(MeshFile&& file, const Array<Eigen::Vector3f>& vertices) {
  MeshColors colors;
  colors.vertices.assign(vertices.begin(), vertices.end());
  colors.triangles = std::move(file.triangles);
  colors.colors = std::move(file.colors);
  colors.material_of = std::move(file.material_of);
  colors.uv = std::move(file.uv);
  for (const MeshMaterial& material : file.materials) {
    const bool is_used = colors.colors.empty() && !material.image.empty();
    colors.images.push_back(is_used ? read_image(material.image) : RgbImage{});
  }
  colors.materials = std::move(file.materials);
  return colors;
}

Box3d bounds_of(const std::vector<Eigen::Vector3d>& vertices) {
  Box3d box{vertices.front(), vertices.front()};
  for (const Eigen::Vector3d& v : vertices) {
    box.min = box.min.cwiseMin(v);
    box.max = box.max.cwiseMax(v);
  }
  return box;
}

}  // namespace

Scene read_mesh_scene(const std::filesystem::path& path) {
  MeshFile file = read_mesh(path);
  if (file.triangles.empty()) throw InputError(fmt::format("{}: has no faces: a scene needs surfaces", path.string()));
  SceneMesh mesh;
  mesh.origin = choose_origin(bounds_of(file.vertices));
  for (const Eigen::Vector3d& v : file.vertices) mesh.vertices.push_back((v - mesh.origin).cast<float>());
  mesh.triangles.assign(file.triangles.begin(), file.triangles.end());
  mesh.surface_of.assign(mesh.triangles.size(), 0);
  mesh.surfaces.resize(1);
  if (has_own_colors(file)) {
    mesh.lighting = Lighting::kNone;
    mesh.own_color = [colors = std::make_shared<const MeshColors>(colors_of(std::move(file), mesh.vertices))](
                         std::uint32_t triangle, const Eigen::Vector3f& point) {
      return mesh_color(*colors, triangle, point);
    };
  }
  return Scene(std::make_shared<const SceneData>(std::move(mesh)));
}

}  // namespace cmap
