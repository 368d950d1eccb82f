#pragma once

#include "scene/surface.hpp"
#include "sensors/noise.hpp"

namespace cmap {

/// Coordinates in the surface, m.
struct SurfaceUv {
  float u, v;
};
inline SurfaceUv uv_of(const Surface& s, const Eigen::Vector3f& p) {
  const Eigen::Vector3f d = p - s.origin;
  return {d.dot(s.u_axis), d.dot(s.v_axis)};
}

inline RgbF times(const RgbF& c, float f) { return {c[0] * f, c[1] * f, c[2] * f}; }
inline RgbF mixed(const RgbF& a, const RgbF& b, float t) {
  return {lerp(a[0], b[0], t), lerp(a[1], b[1], t), lerp(a[2], b[2], t)};
}
/// 1 plus or minus `amount`, from a value in [0,1].
inline float varied(float value, float amount) { return 1.0F + amount * (2.0F * value - 1.0F); }

/// One function per material; point relative to the scene's origin.
RgbF plain_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF brick_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF plaster_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF stone_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF window_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF door_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF roof_texture(const Surface& s, const Eigen::Vector3f& p);

RgbF asphalt_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF paving_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF grass_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF gravel_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF crop_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF water_texture(const Surface& s, const Eigen::Vector3f& p);

RgbF leaves_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF bark_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF car_paint_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF metal_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF wood_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF picture_texture(const Surface& s, const Eigen::Vector3f& p);

RgbF paint_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF carpet_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF floor_tiles_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF ceiling_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF books_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF screen_texture(const Surface& s, const Eigen::Vector3f& p);
RgbF fabric_texture(const Surface& s, const Eigen::Vector3f& p);

}  // namespace cmap
