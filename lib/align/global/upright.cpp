#include "global/upright.hpp"

#include <Eigen/Geometry>

#include "global/main_axes.hpp"
#include "icp/registration_cloud.hpp"

namespace cmap {
namespace {

constexpr double kNearZ = 0.985;      ///< cosine of 10 degrees: a frame's tilt
constexpr double kLeansFromZ = 0.76;  ///< of 40 degrees: slopes and stands
constexpr double kFrequent = 0.4;     ///< of the most frequent axis's share

std::vector<Eigen::Vector3f> some_normals(const PointCloud& thinned) {
  constexpr std::size_t kNormals = 1500, kPlane = 12;
  RegistrationTarget map(thinned, kPlane);
  Array<std::uint32_t> slots;
  const std::size_t n = map.index.points.size;
  for (std::size_t slot = 0; slot < n; slot += n / kNormals + 1) slots.push_back(static_cast<std::uint32_t>(slot));
  map.surface.fit(slots);
  std::vector<Eigen::Vector3f> normals;
  for (const std::uint32_t slot : slots) normals.push_back(map.surface.normal(slot).cast<float>());
  return normals;
}

}  // namespace

Eigen::Vector3d with_longer_tail(const PointCloud& thinned, const Eigen::Vector3d& axis) {
  double mean = 0.0, third_moment = 0.0;
  for (const Eigen::Vector3f& p : thinned.positions) mean += axis.dot(p.cast<double>());
  mean /= static_cast<double>(thinned.size());
  for (const Eigen::Vector3f& p : thinned.positions) third_moment += std::pow(axis.dot(p.cast<double>()) - mean, 3);
  return third_moment < 0.0 ? (-axis).eval() : axis;
}

Ups ups_of(const PointCloud& thinned) {
  const std::vector<MainAxis> axes = main_axes(some_normals(thinned));
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  Ups ups;
  if (axes.empty()) return {true, {z}};
  const double lean = axes[0].direction.z();
  if (std::abs(lean) > kNearZ) {
    const Eigen::Vector3d up = lean < 0.0 ? (-axes[0].direction).eval() : axes[0].direction;
    return {true, {up, -up}};
  }
  if (std::abs(lean) > kLeansFromZ) ups.all.push_back(z);
  for (const MainAxis& axis : axes) {
    if (axis.share < kFrequent * axes[0].share) continue;
    const Eigen::Vector3d up = with_longer_tail(thinned, axis.direction);
    ups.all.push_back(up);
    ups.all.push_back(-up);
  }
  return ups;
}

Eigen::Matrix3d upright_from(const Eigen::Vector3d& up) {
  return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace cmap
