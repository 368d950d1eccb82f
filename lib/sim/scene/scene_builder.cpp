#include "scene/scene_builder.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace cmap {

std::uint32_t SceneBuilder::add(Surface surface) {
  surface.origin = frame * surface.origin;
  surface.u_axis = frame.linear() * surface.u_axis;
  surface.v_axis = frame.linear() * surface.v_axis;
  mesh.surfaces.push_back(surface);
  return static_cast<std::uint32_t>(mesh.surfaces.size() - 1);
}

std::uint32_t SceneBuilder::vertex(const Eigen::Vector3f& point) {
  mesh.vertices.push_back(frame * point);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void SceneBuilder::triangle(std::uint32_t surface, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                            const Eigen::Vector3f& c) {
  const std::uint32_t ia = vertex(a), ib = vertex(b), ic = vertex(c);
  mesh.triangles.push_back({ia, ib, ic});
  mesh.surface_of.push_back(surface);
}

void SceneBuilder::quad(std::uint32_t surface, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                        const Eigen::Vector3f& c, const Eigen::Vector3f& d) {
  const std::uint32_t ia = vertex(a), ib = vertex(b), ic = vertex(c), id = vertex(d);
  mesh.triangles.push_back({ia, ib, ic});
  mesh.triangles.push_back({ia, ic, id});
  mesh.surface_of.insert(mesh.surface_of.end(), 2, surface);
}

void SceneBuilder::box(const Surface& surface, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  const auto corner = [&](int x, int y, int z) {
    return Eigen::Vector3f(x ? high.x() : low.x(), y ? high.y() : low.y(), z ? high.z() : low.z());
  };
  const auto side = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                        const Eigen::Vector3f& d) {
    Surface patch = surface;
    patch.origin = a;
    patch.width = (b - a).norm();
    patch.height = (d - a).norm();
    if (patch.width <= 0.0F || patch.height <= 0.0F) return;
    patch.u_axis = (b - a) / patch.width;
    patch.v_axis = (d - a) / patch.height;
    patch.seed = surface.seed * 6 + static_cast<std::uint32_t>(mesh.surfaces.size());
    quad(add(patch), a, b, c, d);
  };
  side(corner(0, 0, 0), corner(1, 0, 0), corner(1, 0, 1), corner(0, 0, 1));
  side(corner(1, 0, 0), corner(1, 1, 0), corner(1, 1, 1), corner(1, 0, 1));
  side(corner(1, 1, 0), corner(0, 1, 0), corner(0, 1, 1), corner(1, 1, 1));
  side(corner(0, 1, 0), corner(0, 0, 0), corner(0, 0, 1), corner(0, 1, 1));
  side(corner(0, 0, 1), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1));
  side(corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 0), corner(0, 0, 0));
}

void SceneBuilder::cylinder(std::uint32_t surface, const Eigen::Vector3f& base, const Eigen::Vector3f& top,
                            float base_radius, float top_radius, int sides) {
  const Eigen::Vector3f axis = (top - base).normalized();
  const Eigen::Vector3f across = axis.unitOrthogonal(), other = axis.cross(across);
  const auto rim = [&](int i, const Eigen::Vector3f& center, float radius) {
    const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(sides);
    return Eigen::Vector3f(center + radius * (std::cos(angle) * across + std::sin(angle) * other));
  };
  for (int i = 0; i < sides; ++i) {
    const Eigen::Vector3f a = rim(i, top, top_radius), b = rim(i + 1, top, top_radius);
    quad(surface, rim(i, base, base_radius), rim(i + 1, base, base_radius), b, a);
    triangle(surface, top, a, b);
  }
}

Scene SceneBuilder::finish() { return Scene(std::make_shared<const SceneData>(std::move(mesh))); }

Eigen::Isometry3f placed_at(const Eigen::Vector3f& position, float heading_rad) {
  Eigen::Isometry3f frame(Eigen::AngleAxisf(heading_rad, Eigen::Vector3f::UnitZ()));
  frame.translation() = position;
  return frame;
}

}  // namespace cmap
