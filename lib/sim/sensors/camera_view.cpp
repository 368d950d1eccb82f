#include "cmap/sim/camera_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "capture/option_check.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/color.hpp"
#include "scene/light.hpp"
#include "scene/scene_data.hpp"

namespace cmap {
namespace {

constexpr int kTile_px = 16;
/// Rays of a packet form a square of this side.
constexpr int kSide = 4;
static_assert(kSide * kSide == RayCaster::kPacket);
constexpr double kFar_m = 1e5;

/// The rays through the centers of a tile's pixels and of those around it: unit vectors of the world frame.
class TileRays {
 public:
  TileRays(const CameraModel& camera, const Eigen::Matrix3d& R_world_camera, int x0, int y0) : rays_(kSize * kSize) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        rays_[static_cast<std::size_t>(y * kSize + x)] =
            R_world_camera * ray_of(camera, Eigen::Vector2d(x0 + x - 1, y0 + y - 1));
      }
    }
  }

  /// Through the center of the tile's pixel (x, y).
  const Eigen::Vector3d& at(int x, int y) const { return rays_[static_cast<std::size_t>((y + 1) * kSize + x + 1)]; }

  /// Between centers: rays a pixel apart differ so little that bilinear interpolation is off by under 1e-3 px.
  /// Not quite of unit length.
  Eigen::Vector3d between(double x, double y) const {
    const int ix = static_cast<int>(x + 1.0) - 1, iy = static_cast<int>(y + 1.0) - 1;  // floor of -1 and more
    const double tx = x - ix, ty = y - iy;
    const Eigen::Vector3d upper = (1.0 - tx) * at(ix, iy) + tx * at(ix + 1, iy);
    const Eigen::Vector3d lower = (1.0 - tx) * at(ix, iy + 1) + tx * at(ix + 1, iy + 1);
    return (1.0 - ty) * upper + ty * lower;
  }

 private:
  static constexpr int kSize = kTile_px + 2;
  std::vector<Eigen::Vector3d> rays_;
};

/// Rays that start at the camera, cast together.
class ViewCaster {
 public:
  ViewCaster(const Scene& scene, const Eigen::Isometry3d& T_world_camera)
      : scene_(scene), data_(scene.data()), center_(T_world_camera.translation() - data_.mesh.origin) {}

  using Directions = std::array<Eigen::Vector3d, RayCaster::kPacket>;  ///< world frame
  using Distances = std::array<double, RayCaster::kPacket>;
  using Colors = std::array<Eigen::Vector3f, RayCaster::kPacket>;

  Distances distances(const Directions& directions) const {
    const Packet packet = cast(directions);
    Distances result;
    for (std::size_t i = 0; i < RayCaster::kPacket; ++i) {
      result[i] = packet.triangles[i] == RayCaster::kNone
                      ? std::numeric_limits<double>::infinity()
                      : data_.meet(packet.triangles[i], center_, packet.directions[i]).distance;
    }
    return result;
  }

  Colors colors(const Directions& directions) const {
    const Packet packet = cast(directions);
    std::array<SurfacePoint, RayCaster::kPacket> points;
    std::array<Ray, RayCaster::kPacket> to_sun;
    std::array<std::size_t, RayCaster::kPacket> lane_of{};
    std::array<std::uint8_t, RayCaster::kPacket> in_shadow, blocked;
    in_shadow.fill(1);
    std::size_t n = 0;
    for (std::size_t i = 0; i < RayCaster::kPacket; ++i) {
      if (packet.triangles[i] == RayCaster::kNone) continue;
      points[i] = point_on(packet.triangles[i], packet.directions[i]);
      if (const auto ray = data_.shadow_ray(points[i])) {
        to_sun[n] = *ray;
        lane_of[n++] = i;
      }
    }
    if (n > 0) data_.caster.are_blocked(std::span(to_sun).first(n), blocked);
    for (std::size_t k = 0; k < n; ++k) in_shadow[lane_of[k]] = blocked[k];
    return shaded(packet, points, in_shadow);
  }

 private:
  struct Packet {
    const Directions& directions;
    std::array<std::uint32_t, RayCaster::kPacket> triangles;
  };

  Packet cast(const Directions& directions) const {
    Packet packet{directions, {}};
    std::array<Ray, RayCaster::kPacket> rays;
    for (std::size_t i = 0; i < RayCaster::kPacket; ++i) {
      const bool is_seen = directions[i].allFinite();
      rays[i] = {center_.cast<float>(), is_seen ? directions[i].cast<float>() : Eigen::Vector3f::UnitZ().eval(),
                 is_seen ? static_cast<float>(kFar_m) : 0.0F};
    }
    data_.caster.first(rays, packet.triangles);
    return packet;
  }

  SurfacePoint point_on(std::uint32_t triangle, const Eigen::Vector3d& direction) const {
    const PlaneHit plane = data_.meet(triangle, center_, direction);
    return {triangle, (center_ + plane.distance * direction).cast<float>(), plane.normal};
  }

  Colors shaded(const Packet& packet, const std::array<SurfacePoint, RayCaster::kPacket>& points,
                const std::array<std::uint8_t, RayCaster::kPacket>& in_shadow) const {
    Colors result;
    for (std::size_t i = 0; i < RayCaster::kPacket; ++i) {
      RgbF color{};
      if (packet.triangles[i] != RayCaster::kNone) {
        color = data_.color(points[i], in_shadow[i] != 0);
      } else if (packet.directions[i].allFinite()) {
        color = scene_.sky(packet.directions[i].normalized());
      }
      result[i] = Eigen::Vector3f(color[0], color[1], color[2]);
    }
    return result;
  }

  const Scene& scene_;
  const SceneData& data_;
  Eigen::Vector3d center_;  ///< relative to the scene's origin
};

/// Light that arrives at a pixel, of 1 in the middle.
double vignette(const CameraModel& camera, const ViewOptions& options, int x, int y) {
  const double cx = 0.5 * (camera.width - 1), cy = 0.5 * (camera.height - 1);
  const double sq_radius = (x - cx) * (x - cx) + (y - cy) * (y - cy);
  return 1.0 - options.vignetting * sq_radius / std::max(1.0, cx * cx + cy * cy);
}

/// The part of a view from (x0, y0) to beyond its tile's end.
class TilePainter {
 public:
  TilePainter(const CameraModel& camera, const Eigen::Matrix3d& R_world_camera, const ViewOptions& options,
              const ViewCaster& caster, int x0, int y0)
      : camera_(camera),
        axis_(R_world_camera.col(2)),
        options_(options),
        caster_(caster),
        x0_(x0),
        y0_(y0),
        rays_(camera, R_world_camera, x0, y0) {}

  void paint_depth(Array<float>& depth_m) const {
    for (int y = 0; y < kTile_px; y += kSide) {
      for (int x = 0; x < kTile_px; x += kSide) {
        ViewCaster::Directions rays;
        for (int k = 0; k < kSide * kSide; ++k)
          rays[static_cast<std::size_t>(k)] = rays_.at(x + k % kSide, y + k / kSide);
        const ViewCaster::Distances distances = caster_.distances(rays);
        for (int k = 0; k < kSide * kSide; ++k) {
          const int px = x0_ + x + k % kSide, py = y0_ + y + k / kSide;
          if (px >= camera_.width || py >= camera_.height) continue;
          const auto lane = static_cast<std::size_t>(k);
          depth_m[pixel_index(px, py)] = static_cast<float>(
              std::isfinite(distances[lane]) ? distances[lane] * rays[lane].dot(axis_) : distances[lane]);
        }
      }
    }
  }

  void paint_color(RgbImage& image) const {
    std::vector<Eigen::Vector3f> sums(kTile_px * kTile_px, Eigen::Vector3f::Zero());
    const int s = options_.supersampling;
    for (int y = 0; y < kTile_px * s; y += kSide) {
      for (int x = 0; x < kTile_px * s; x += kSide) {
        if (x0_ + x / s >= camera_.width || y0_ + y / s >= camera_.height) continue;
        ViewCaster::Directions rays;
        for (int k = 0; k < kSide * kSide; ++k)
          rays[static_cast<std::size_t>(k)] = sample_ray(x + k % kSide, y + k / kSide);
        const ViewCaster::Colors colors = caster_.colors(rays);
        for (int k = 0; k < kSide * kSide; ++k) {
          const int px = (x + k % kSide) / s, py = (y + k / kSide) / s;
          sums[static_cast<std::size_t>(py * kTile_px + px)] += colors[static_cast<std::size_t>(k)];
        }
      }
    }
    for (int y = 0; y < kTile_px && y0_ + y < camera_.height; ++y) {
      for (int x = 0; x < kTile_px && x0_ + x < camera_.width; ++x) {
        const double gain = options_.exposure_gain * vignette(camera_, options_, x0_ + x, y0_ + y);
        const Eigen::Vector3f& sum = sums[static_cast<std::size_t>(y * kTile_px + x)];
        image.pixels[pixel_index(x0_ + x, y0_ + y)] = to_rgb8(static_cast<float>(255.0 * gain / (s * s)) * sum);
      }
    }
  }

 private:
  /// Through sample (x, y) of the tile's grid of supersampling x supersampling samples per pixel.
  Eigen::Vector3d sample_ray(int x, int y) const {
    const int s = options_.supersampling;
    if (s == 1) return rays_.at(x, y);
    return rays_.between((x + 0.5) / s - 0.5, (y + 0.5) / s - 0.5);
  }

  std::size_t pixel_index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) + static_cast<std::size_t>(x);
  }

  const CameraModel& camera_;
  Eigen::Vector3d axis_;  ///< optical, world frame
  const ViewOptions& options_;
  const ViewCaster& caster_;
  int x0_, y0_;
  TileRays rays_;
};

void check(const ViewOptions& options) {
  require_between("supersampling", options.supersampling, 1, 8);
  require_between("vignetting", options.vignetting, 0.0, 1.0);
  require_between("exposure_gain", options.exposure_gain, 1e-3, 1e3);
}

std::size_t pixel_count(const CameraModel& camera) {
  return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
}

/// Calls paint(painter) for every tile, in parallel.
template <class Paint>
void for_each_tile(const Scene& scene, const CameraModel& camera, const Eigen::Isometry3d& T_world_camera,
                   const ViewOptions& options, Paint&& paint) {
  const ViewCaster caster(scene, T_world_camera);
  const int tiles_x = (camera.width + kTile_px - 1) / kTile_px, tiles_y = (camera.height + kTile_px - 1) / kTile_px;
  const auto tiles = static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y);
  parallel_chunks(tiles, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t tile = begin; tile < end; ++tile) {
      const int x0 = kTile_px * static_cast<int>(tile % static_cast<std::size_t>(tiles_x));
      const int y0 = kTile_px * static_cast<int>(tile / static_cast<std::size_t>(tiles_x));
      paint(TilePainter(camera, T_world_camera.linear(), options, caster, x0, y0));
    }
  });
}

}  // namespace

RgbImage render_image(const Scene& scene, const CameraModel& camera, const Eigen::Isometry3d& T_world_camera,
                      const ViewOptions& options) {
  check(camera);
  check(options);
  RgbImage image{camera.width, camera.height, Array<Rgb8>(pixel_count(camera))};
  for_each_tile(scene, camera, T_world_camera, options,
                [&](const TilePainter& painter) { painter.paint_color(image); });
  return image;
}

Array<float> render_depth(const Scene& scene, const CameraModel& camera, const Eigen::Isometry3d& T_world_camera) {
  check(camera);
  Array<float> depth_m(pixel_count(camera));
  for_each_tile(scene, camera, T_world_camera, {}, [&](const TilePainter& painter) { painter.paint_depth(depth_m); });
  return depth_m;
}

CameraView render_view(const Scene& scene, const CameraModel& camera, const Eigen::Isometry3d& T_world_camera,
                       const ViewOptions& options) {
  return {render_image(scene, camera, T_world_camera, options), render_depth(scene, camera, T_world_camera)};
}

}  // namespace cmap
