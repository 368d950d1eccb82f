#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>

namespace cmap {

struct Ray {
  Eigen::Vector3f origin, direction;
  float max_distance = 0.0F;
};

/// Finds the triangles that rays meet. Rays are relative to the mesh's origin; thread-safe.
class RayCaster {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;
  /// Rays that are cast together: the widest packet of Embree.
  static constexpr std::size_t kPacket = 16;

  RayCaster(std::span<const Eigen::Vector3f> vertices, std::span<const std::array<std::uint32_t, 3>> triangles);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// The first triangle along the ray, kNone if there is none.
  std::uint32_t first(const Ray& ray) const;
  /// The same for up to kPacket rays that lie close together.
  void first(std::span<const Ray> rays, std::span<std::uint32_t> triangles) const;

  /// Whether any triangle lies on the ray.
  bool is_blocked(const Ray& ray) const;
  /// The same for up to kPacket rays; blocked[i] becomes 0 or 1.
  void are_blocked(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace cmap
