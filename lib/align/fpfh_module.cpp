// What global registration loads when it is asked for: PCL's FPFH features.

#include "fpfh_module.hpp"

#include <pcl/features/fpfh_omp.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include "cmap/core/loaded_module.hpp"

namespace cmap {
namespace {

void features_of(const float* xyz, const float* normals, std::size_t n, double radius_m, int threads,
                 float* histograms) {
  const pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
  cloud->resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    pcl::PointNormal& point = (*cloud)[i];
    std::copy_n(xyz + 3 * i, 3, point.data);
    std::copy_n(normals + 3 * i, 3, point.data_n);
  }
  pcl::FPFHEstimationOMP<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation(
      static_cast<unsigned>(threads));
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointNormal>>());
  estimation.setRadiusSearch(radius_m);
  pcl::PointCloud<pcl::FPFHSignature33> features;
  estimation.compute(features);
  for (std::size_t i = 0; i < n; ++i) std::copy_n(features[i].histogram, 33, histograms + 33 * i);
}

constexpr FpfhTable kTable{.features = features_of};

}  // namespace
}  // namespace cmap

cmap::ModuleAnswer cmap_module(const char* build, const cmap::ModuleHost* host) {
  return cmap::answer_of_module(cmap::kTable, build, host);
}
