#include "cmap/spatial/visibility.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kVoxelChunk = 64;

/// Sums of a voxel's points, from its center.
struct VoxelPoints {
  double n = 0.0;
  Vector3d sum = Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();

  void add(const Vector3d& p) {
    n += 1.0;
    sum += p;
    scatter += p * p.transpose();
  }
  Vector3d mean() const { return sum / n; }
  /// Zero where the points make no surface.
  Vector3d normal() const {
    constexpr double kFewest = 4.0, kThinnest = 0.1;
    if (n < kFewest) return Vector3d::Zero();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter - sum * sum.transpose() / n);
    const bool is_surface = eigen.eigenvalues()[0] < kThinnest * eigen.eigenvalues()[1];
    return is_surface ? Vector3d(eigen.eigenvectors().col(0)) : Vector3d::Zero();
  }
};

/// One bit for each voxel of a box: whether it holds points.
class OccupancyGrid {
 public:
  OccupancyGrid(const Box3d& box, double voxel_m) : corner_(box.min), voxel_m_(voxel_m) {
    double n = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cells = std::floor((box.max[axis] - box.min[axis]) / voxel_m) + 1.0;
      n *= cells;
      size_[axis] = static_cast<std::int64_t>(std::min(cells, 1e15));
    }
    constexpr double kMost = 64e9;  // 8 GB
    if (n > kMost) {
      throw UsageError(
          fmt::format("the space around the map has {:.2g} voxels of {:g} m: use larger ones", n, voxel_m));
    }
    bits_.assign((static_cast<std::size_t>(n) + 63) / 64, 0);
  }

  void set(const Vector3d& world) {
    const Eigen::Array<std::int64_t, 3, 1> cell = cell_of(world);
    const std::size_t i = index(cell);
    bits_[i / 64] |= std::uint64_t{1} << (i % 64);
  }

  /// Whether any voxel on the way, both ends left out, holds points (Amanatides and Woo 1987).
  bool blocks(const Vector3d& from, const Vector3d& to) const {
    const Vector3d direction = to - from;
    Eigen::Array<std::int64_t, 3, 1> cell = cell_of(from);
    const Eigen::Array<std::int64_t, 3, 1> last = cell_of(to);
    Vector3d next, step;  // parameters along the way, 0 to 1
    for (int axis = 0; axis < 3; ++axis) {
      const double border =
          corner_[axis] + voxel_m_ * static_cast<double>(cell[axis] + (direction[axis] > 0.0 ? 1 : 0));
      const bool moves = direction[axis] != 0.0;
      next[axis] = moves ? (border - from[axis]) / direction[axis] : std::numeric_limits<double>::infinity();
      step[axis] = moves ? voxel_m_ / std::abs(direction[axis]) : std::numeric_limits<double>::infinity();
    }
    while (true) {
      int axis = 0;
      next.minCoeff(&axis);
      if (next[axis] >= 1.0) return false;
      next[axis] += step[axis];
      cell[axis] += direction[axis] > 0.0 ? 1 : -1;
      if ((cell == last).all()) return false;
      if (is_set(cell)) return true;
    }
  }

 private:
  Eigen::Array<std::int64_t, 3, 1> cell_of(const Vector3d& world) const {
    return ((world - corner_) / voxel_m_).array().floor().cast<std::int64_t>();
  }
  std::size_t index(const Eigen::Array<std::int64_t, 3, 1>& cell) const {
    return static_cast<std::size_t>((cell.z() * size_.y() + cell.y()) * size_.x() + cell.x());
  }
  bool is_set(const Eigen::Array<std::int64_t, 3, 1>& cell) const {
    if ((cell < 0).any() || (cell >= size_).any()) return false;
    const std::size_t i = index(cell);
    return (bits_[i / 64] >> (i % 64) & 1) != 0;
  }

  Vector3d corner_;
  double voxel_m_;
  Eigen::Array<std::int64_t, 3, 1> size_;
  std::vector<std::uint64_t> bits_;
};

std::vector<Vector3d> apart(std::span<const Vector3d> positions, double distance_m) {
  std::vector<Vector3d> kept;
  for (const Vector3d& p : positions) {
    if (kept.empty() || (p - kept.back()).norm() >= distance_m) kept.push_back(p);
  }
  return kept;
}

/// Whether a surface is in sight of any position.
bool in_sight(const OccupancyGrid& grid, const Vector3d& surface, const Vector3d& normal,
              std::span<const Vector3d> positions, const VisibilityOptions& options) {
  const double above_m = std::sqrt(3.0) * options.voxel_m;
  for (const Vector3d& position : positions) {
    const Vector3d toward = position - surface;
    const double range_m = toward.norm();
    if (range_m > options.range_m) continue;
    if (range_m <= 2.0 * above_m) return true;
    const Vector3d away =
        normal.isZero() ? Vector3d(toward / range_m) : Vector3d(toward.dot(normal) < 0.0 ? -normal : normal);
    if (!grid.blocks(surface + above_m * away, position)) return true;
  }
  return false;
}

}  // namespace

VisibleSurfaces::VisibleSurfaces(const Bvh& map, std::span<const Vector3d> positions, const VisibilityOptions& options)
    : frame_(map.bounds(), options.voxel_m), box_(map.bounds()) {
  if (positions.empty()) throw std::invalid_argument("visibility: a sensor without positions");
  const std::vector<Vector3d> kept = apart(positions, options.voxel_m);
  n_positions_ = kept.size();
  VoxelMap<VoxelPoints> voxels;
  for (std::size_t slot = 0; slot < map.points.size; ++slot) {
    const Vector3d p = map.points.world(slot);
    const VoxelKey key = frame_.key(p);
    voxels[key].add(p - frame_.center(key));
  }
  const auto& entries = voxels.entries();
  // Whole voxels of the frame, so that both have the same borders.
  const double half = 0.5 * options.voxel_m;
  OccupancyGrid grid({frame_.center(frame_.key(box_.min)).array() - half, frame_.center(frame_.key(box_.max)).array()},
                     options.voxel_m);
  for (const auto& [key, points] : entries) grid.set(frame_.center(key));
  std::vector<std::uint8_t> seen(entries.size());
  parallel_chunks(entries.size(), kVoxelChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [key, points] = entries[i];
      seen[i] = in_sight(grid, frame_.center(key) + points.mean(), points.normal(), kept, options) ? 1 : 0;
    }
  });
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (seen[i] != 0) seen_[entries[i].key] = true;
  }
}

bool VisibleSurfaces::contains(const Vector3d& world) const {
  // Far away the frame has no keys.
  const bool is_near = (world.array() > box_.min.array() - 1.0).all() && (world.array() < box_.max.array() + 1.0).all();
  return is_near && seen_.find(frame_.key(world)) != nullptr;
}

}  // namespace cmap
