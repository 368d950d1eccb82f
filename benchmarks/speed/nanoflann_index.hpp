#pragma once

// nanoflann's tree over a cloud of ours: leaves of 16, float.

#include <nanoflann.hpp>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap::benchmarks {

struct NanoflannView {
  const PointCloud& cloud;
  std::size_t kdtree_get_point_count() const { return cloud.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return cloud.positions[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using NanoflannTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, NanoflannView>,
                                                          NanoflannView, 3, std::uint32_t>;

struct NanoflannIndex {
  explicit NanoflannIndex(const PointCloud& cloud)
      : view{cloud}, tree(3, view, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {
    tree.buildIndex();
  }
  NanoflannView view;
  NanoflannTree tree;
};

}  // namespace cmap::benchmarks
