// GICP against PCL's on pairs of real clouds: thinning, normals or covariances, and iterations included. Both get the
// same voxel, distance and start. The figure to compare is the CPU time of the process; error_m and error_deg say what
// for.

#include <benchmark/benchmark.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/gicp.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "cmap/align/icp.hpp"
#include "cmap/geometry/similarity.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/transform_file.hpp"

namespace {

using cmap::PointCloud;
using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

struct Pair {
  PointCloud source, target;
  cmap::Similarity truth;
  double voxel_m, max_distance_m;
};

std::filesystem::path data_folder() {
  const char* folder = std::getenv("CMAP_DATA_DIR");
  return folder ? folder : "../shared/data";
}

Pair lidar_pair() {
  const auto folder = data_folder() / "small_gicp/data";
  return {cmap::read_point_cloud(folder / "source.ply").cloud, cmap::read_point_cloud(folder / "target.ply").cloud,
          cmap::similarity_from(cmap::read_transform(folder / "T_target_source.txt").T), 0.2, 2.0};
}

/// The aerial map against itself, turned by a degree and moved by a meter.
Pair aerial_pair() {
  const PointCloud map = cmap::read_point_cloud(data_folder() / "autzen/autzen_stadium_300m.ply").cloud;
  const cmap::Similarity truth{1.0, cmap::rotation_from({0.005, -0.005, 0.015}), {0.7, -0.6, 0.3}};
  return {cmap::transformed(map, truth.inverse().matrix()), map, truth, 1.0, 5.0};
}

const Pair& pair_number(long number) {
  static const Pair pairs[] = {lidar_pair(), aerial_pair()};
  return pairs[number];
}

void report(benchmark::State& state, const Pair& pair, const cmap::Similarity& T) {
  // At the source's center: translations at an origin far away say nothing.
  const cmap::Box3d box = cmap::bounds(pair.source);
  const Eigen::Vector3d center = 0.5 * (box.min + box.max);
  state.counters["error_m"] = (T * center - pair.truth * center).norm();
  state.counters["error_deg"] = cmap::rotation_angle_rad(T.rotation.transpose() * pair.truth.rotation) * 180.0 / M_PI;
}

/// The same voxel and distance as PCL's.
std::vector<cmap::IcpLevel> one_level(const Pair& pair) { return {{pair.voxel_m, pair.max_distance_m, 100}}; }
/// What cmap_align does.
std::vector<cmap::IcpLevel> three_levels(const Pair& pair) {
  return cmap::coarse_to_fine(pair.voxel_m, pair.max_distance_m);
}
/// Still better than PCL's result with the fine voxel.
std::vector<cmap::IcpLevel> larger_voxel(const Pair& pair) { return {{3.0 * pair.voxel_m, pair.max_distance_m, 100}}; }

void gicp_cmap(benchmark::State& state, std::vector<cmap::IcpLevel> (*levels)(const Pair&)) {
  const Pair& pair = pair_number(state.range(0));
  cmap::IcpOptions options;
  options.levels = levels(pair);
  cmap::Alignment found;
  for (auto _ : state) found = cmap::icp(pair.source, pair.target, Eigen::Matrix4d::Identity(), options);
  report(state, pair, cmap::similarity_from(found.T_dst_src));
}

PclCloud::Ptr thinned_by_pcl(const PclCloud::Ptr& cloud, double voxel_m) {
  const PclCloud::Ptr thinned(new PclCloud);
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setLeafSize(static_cast<float>(voxel_m), static_cast<float>(voxel_m), static_cast<float>(voxel_m));
  grid.setInputCloud(cloud);
  grid.filter(*thinned);
  return thinned;
}

PclCloud::Ptr to_pcl(const PointCloud& cloud) {
  const PclCloud::Ptr result(new PclCloud);
  for (const Eigen::Vector3f& p : cloud.positions) {
    const auto world = [&](int axis) { return static_cast<float>(cloud.origin[axis] + static_cast<double>(p[axis])); };
    result->emplace_back(world(0), world(1), world(2));
  }
  return result;
}

/// PCL's own limits for a step, or those of IcpOptions.
void gicp_pcl(benchmark::State& state, bool to_the_end) {
  const Pair& pair = pair_number(state.range(0));
  const PclCloud::Ptr source = to_pcl(pair.source), target = to_pcl(pair.target);
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  for (auto _ : state) {
    pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> gicp;
    gicp.setInputSource(thinned_by_pcl(source, pair.voxel_m));
    gicp.setInputTarget(thinned_by_pcl(target, pair.voxel_m));
    gicp.setMaxCorrespondenceDistance(pair.max_distance_m);
    gicp.setMaximumIterations(100);
    if (to_the_end) {
      gicp.setTransformationEpsilon(1e-6);
      gicp.setRotationEpsilon(1e-5);
    }
    PclCloud moved;
    gicp.align(moved);
    T = gicp.getFinalTransformation().cast<double>();
  }
  report(state, pair, cmap::similarity_from(T));
}

void pairs(benchmark::internal::Benchmark* b) {
  b->ArgName("pair")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->MinWarmUpTime(0.001);
}

BENCHMARK_CAPTURE(gicp_cmap, one_level, &one_level)->Apply(pairs);
BENCHMARK_CAPTURE(gicp_cmap, three_levels, &three_levels)->Apply(pairs);
BENCHMARK_CAPTURE(gicp_cmap, larger_voxel, &larger_voxel)->Apply(pairs);
BENCHMARK_CAPTURE(gicp_pcl, own_limits, false)->Apply(pairs);
BENCHMARK_CAPTURE(gicp_pcl, to_the_end, true)->Apply(pairs);

}  // namespace

BENCHMARK_MAIN();
