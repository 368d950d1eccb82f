#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>

#include "cmap/core/array.hpp"

namespace cmap {

using Rgb8 = std::array<std::uint8_t, 3>;
using Rgb16 = std::array<std::uint16_t, 3>;
using RgbF = std::array<float, 3>;

/// Colors as a file stores them, one per point, or none at all. 8 bit: 0..255; 16 bit: 0..65535; float: [0,1].
using Colors = std::variant<std::monostate, Array<Rgb8>, Array<Rgb16>, Array<RgbF>>;

/// "none", "u8", "u16" or "f32", as reports name it.
std::string_view color_type_name(const Colors& colors);

/// Axis-aligned box in the world frame, meters.
struct Box3d {
  Eigen::Vector3d min;
  Eigen::Vector3d max;
};

/// The eight of them; x changes first.
inline std::array<Eigen::Vector3d, 8> corners(const Box3d& box) {
  std::array<Eigen::Vector3d, 8> all;
  for (unsigned i = 0; i < all.size(); ++i) {
    all[i] = {(i & 1 ? box.max : box.min).x(), (i & 2 ? box.max : box.min).y(), (i & 4 ? box.max : box.min).z()};
  }
  return all;
}

/// The smallest box around both.
inline Box3d united(const Box3d& a, const Box3d& b) { return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)}; }

/// Points of a map: world position of point i = origin + positions[i], in meters.
///
/// The double-precision origin lets float offsets hold UTM coordinates without loss. `colors` has as many entries as
/// `positions`, or none. Readers drop non-finite points; whoever fills a cloud by hand must do the same.
struct PointCloud {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Array<Eigen::Vector3f> positions;
  Colors colors;
  double file_step_m = 0.0;  ///< in which the file held the coordinates (LAS: the coarsest axis); 0: not known

  std::size_t size() const { return positions.size(); }
  bool has_color() const { return !std::holds_alternative<std::monostate>(colors); }
  Eigen::Vector3d world(std::size_t i) const { return origin + positions[i].cast<double>(); }
};

/// Bounds in the world frame. Throws std::invalid_argument on an empty cloud.
Box3d bounds(const PointCloud& cloud);

/// The origin that a cloud with these bounds gets: on every axis the multiple of a power of ten (at least 100 m and the
/// extent) that is nearest to the box's center. A cloud around zero keeps its floats as they are, and two clouds that
/// differ by a shift of such round numbers get the same offsets, and so the same scores.
Eigen::Vector3d choose_origin(const Box3d& box);

/// Largest coordinate magnitude (m) accepted anywhere: squared distances must stay finite in float.
inline constexpr double kMaxCoordinate_m = 1e12;

/// A copy of the points for which keep[i] != 0, in order. Throws std::invalid_argument on a size mismatch.
PointCloud select(const PointCloud& cloud, const Array<std::uint8_t>& keep);

/// The points inside the box (bounds included), world frame.
PointCloud crop(const PointCloud& cloud, const Box3d& box);

/// Every k-th point without its color, at most about `most`.
PointCloud sampled(const PointCloud& cloud, std::size_t most);

/// The points moved by the homogeneous transform T_new_old (rigid or similarity; world frames), computed in double.
PointCloud transformed(const PointCloud& cloud, const Eigen::Matrix4d& T_new_old);

}  // namespace cmap
