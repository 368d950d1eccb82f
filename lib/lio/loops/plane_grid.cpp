#include "loops/plane_grid.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace cmap {
namespace {

constexpr std::size_t kFewest = 6;
constexpr double kColumnVoxels = 4.0;

std::int32_t floor_index(double v) { return static_cast<std::int32_t>(std::floor(v)); }

}  // namespace

std::optional<PlanePatch> plane_of(std::span<const Eigen::Vector3d> points, double size_m) {
  if (points.size() < kFewest) return std::nullopt;
  PlanePatch patch;
  patch.n = points.size();
  for (const Eigen::Vector3d& p : points) patch.mean += p;
  patch.mean /= static_cast<double>(points.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) moments += (p - patch.mean) * (p - patch.mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments / static_cast<double>(points.size()));
  const Eigen::Vector3d spread = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (spread[1] < size_m / 8.0 || spread[0] > spread[1] / 3.0) return std::nullopt;
  patch.normal = axes.eigenvectors().col(0);
  patch.thickness_m = spread[0];
  return patch;
}

PlaneGrid::PlaneGrid(const PointCloud& cloud, double size_m) : size_m_(size_m) {
  VoxelMap<std::vector<Eigen::Vector3d>> members;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.world(i);
    members[key(p)].push_back(p);
    seen_[column(p)] = 1;
  }
  for (const auto& [voxel, points] : members.entries()) {
    const std::optional<PlanePatch> patch = plane_of(points, size_m);
    if (!patch) continue;
    by_voxel_[voxel] = static_cast<std::uint32_t>(patches_.size());
    patches_.push_back(*patch);
  }
}

VoxelKey PlaneGrid::key(const Eigen::Vector3d& p) const {
  return {floor_index(p.x() / size_m_), floor_index(p.y() / size_m_), floor_index(p.z() / size_m_)};
}

VoxelKey PlaneGrid::column(const Eigen::Vector3d& p) const {
  const double size_m = kColumnVoxels * size_m_;
  return {floor_index(p.x() / size_m), floor_index(p.y() / size_m), 0};
}

const PlanePatch* PlaneGrid::nearest(const Eigen::Vector3d& p) const {
  const VoxelKey home = key(p);
  const PlanePatch* best = nullptr;
  double least_m = size_m_;
  const auto look = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    const std::uint32_t* const place = by_voxel_.find({home.x + x, home.y + y, home.z + z});
    if (place == nullptr) return;
    const PlanePatch& patch = patches_[*place];
    const double along_m = (p - patch.mean).norm();
    const double across_m = std::abs(patch.normal.dot(p - patch.mean));
    if (along_m < 1.5 * size_m_ && across_m < least_m) {
      best = &patch;
      least_m = across_m;
    }
  };
  look(0, 0, 0);
  for (const std::int32_t step : {-1, 1}) {
    look(step, 0, 0);
    look(0, step, 0);
    look(0, 0, step);
  }
  return best;
}

}  // namespace cmap
