#include "icp/moving_source.hpp"

#include <utility>

#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

constexpr std::size_t kBlockChunk = 1024;

struct PointSum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  PointSum& operator+=(const PointSum& other) {
    sum += other.sum;
    return *this;
  }
};

Eigen::Vector3d center_of(const PointBlocks& points) {
  const auto total =
      ordered_sum<PointSum>(points.size, kBlockChunk * kBlockSize, [&](std::size_t begin, std::size_t end) {
        PointSum part;
        for (std::size_t slot = begin; slot < end; ++slot) part.sum += points.offset(slot).cast<double>();
        return part;
      });
  return total.sum / static_cast<double>(points.size);
}

void move_block(const Eigen::Matrix3d& linear, const Eigen::Vector3d& shift, const PointBlock& from, PointBlock& to) {
  const double* m = linear.data();  // by columns
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const double x = from.x[i], y = from.y[i], z = from.z[i];
    to.x[i] = static_cast<float>(m[0] * x + m[3] * y + m[6] * z + shift[0]);
    to.y[i] = static_cast<float>(m[1] * x + m[4] * y + m[7] * z + shift[1]);
    to.z[i] = static_cast<float>(m[2] * x + m[5] * y + m[8] * z + shift[2]);
  }
}

}  // namespace

Similarity local_transform(const Similarity& T_dst_src, const Eigen::Vector3d& src_origin,
                           const Eigen::Vector3d& dst_origin) {
  return {T_dst_src.scale, T_dst_src.rotation, T_dst_src * src_origin - dst_origin};
}

Similarity world_transform(const Similarity& local, const Eigen::Vector3d& src_origin,
                           const Eigen::Vector3d& dst_origin) {
  return {local.scale, local.rotation, local.translation + dst_origin - local.linear() * src_origin};
}

MovingSource::MovingSource(PointBlocks sorted_points) : points_(std::move(sorted_points)), center_(center_of(points_)) {
  moved_.size = points_.size;
  moved_.blocks.resize(points_.blocks.size());
}

NearestField MovingSource::nearest(const Bvh& target, const Similarity& local) {
  moved_.origin = target.points.origin;
  const Eigen::Matrix3d linear = local.linear();
  parallel_chunks(points_.blocks.size(), kBlockChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      move_block(linear, local.translation, points_.blocks[block], moved_.blocks[block]);
    }
  });
  return find_nearest(target, moved_);
}

}  // namespace cmap
