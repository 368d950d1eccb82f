#include <algorithm>
#include <flann/flann.hpp>
#include <vector>

#include "cmap/core/parallel.hpp"
#include "cmap/spatial/nearest.hpp"

namespace cmap {
namespace {

/// The points as rows of x y z in double, moved by `shift`.
std::vector<double> rows(const PointBlocks& points, const Eigen::Vector3d& shift) {
  std::vector<double> xyz(3 * points.size);
  for (std::size_t slot = 0; slot < points.size; ++slot) {
    const Eigen::Vector3d p = points.offset(slot).cast<double>() + shift;
    std::copy_n(p.data(), 3, &xyz[3 * slot]);
  }
  return xyz;
}

}  // namespace

NearestField find_nearest_flann(const PointBlocks& index, const PointBlocks& queries) {
  std::vector<double> index_xyz = rows(index, Eigen::Vector3d::Zero());
  std::vector<double> query_xyz = rows(queries, queries.origin - index.origin);
  flann::Index<flann::L2_Simple<double>> tree(flann::Matrix<double>(index_xyz.data(), index.size, 3),
                                              flann::KDTreeSingleIndexParams(16));
  tree.buildIndex();

  NearestField field{Array<std::uint32_t>(queries.size), Array<double>(queries.size)};
  parallel_chunks(queries.size, std::size_t{1} << 14, [&](std::size_t begin, std::size_t end) {
    std::vector<std::size_t> slots(end - begin);
    flann::Matrix<double> query_rows(&query_xyz[3 * begin], end - begin, 3);
    flann::Matrix<std::size_t> slot_rows(slots.data(), end - begin, 1);
    flann::Matrix<double> dist_rows(&field.sq_dist[begin], end - begin, 1);
    tree.knnSearch(query_rows, slot_rows, dist_rows, 1, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    for (std::size_t i = begin; i < end; ++i) field.slot[i] = static_cast<std::uint32_t>(slots[i - begin]);
  });
  return field;
}

}  // namespace cmap
