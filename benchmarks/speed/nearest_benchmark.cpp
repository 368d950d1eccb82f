// Nearest neighbors of both maps in each other, sort and build included: cmap against nanoflann, FLANN, PCL and Open3D.
// The figure to compare is the CPU time of the process, as peers use one thread.

#include <benchmark/benchmark.h>

#include <flann/flann.hpp>

#include "cmap/spatial/nearest.hpp"
#include "town_pair.hpp"

#ifdef CMAP_WITH_NANOFLANN
#include "nanoflann_index.hpp"
#endif
#ifdef CMAP_WITH_PCL
#include <pcl/kdtree/kdtree_flann.h>
#endif
#ifdef CMAP_WITH_OPEN3D
#include <open3d/geometry/KDTreeFlann.h>
#include <open3d/geometry/PointCloud.h>
#endif

namespace {

using cmap::PointCloud;

/// Sum of the distances from every query to its nearest point.
using SumOfDistances = double (*)(const PointCloud& data, const PointCloud& queries);

double cmap_both_ways(const cmap::benchmarks::TownPair& town) {
  const cmap::Bvh reference(cmap::sort_points(town.reference));
  const cmap::Bvh estimate(cmap::sort_points(town.estimate));
  double sum = 0.0;
  for (double sq : cmap::find_nearest(reference, estimate.points).sq_dist) sum += std::sqrt(sq);
  for (double sq : cmap::find_nearest(estimate, reference.points).sq_dist) sum += std::sqrt(sq);
  return sum;
}

#ifdef CMAP_WITH_NANOFLANN
double nanoflann_sum(const PointCloud& data, const PointCloud& queries) {
  const cmap::benchmarks::NanoflannIndex index(data);
  double sum = 0.0;
  for (const auto& q : queries.positions) {
    std::uint32_t nearest = 0;
    float sq_dist = 0.0f;
    index.tree.knnSearch(q.data(), 1, &nearest, &sq_dist);
    sum += std::sqrt(static_cast<double>(sq_dist));
  }
  return sum;
}
#endif

double flann_sum(const PointCloud& data, const PointCloud& queries) {
  std::vector<float> xyz(3 * data.size());
  for (std::size_t i = 0; i < data.size(); ++i) std::copy_n(data.positions[i].data(), 3, &xyz[3 * i]);
  flann::Index<flann::L2_Simple<float>> tree(flann::Matrix<float>(xyz.data(), data.size(), 3),
                                             flann::KDTreeSingleIndexParams(15));
  tree.buildIndex();
  double sum = 0.0;
  for (auto q : queries.positions) {
    std::size_t index = 0;
    float sq_dist = 0.0f;
    flann::Matrix<std::size_t> indices(&index, 1, 1);
    flann::Matrix<float> dists(&sq_dist, 1, 1);
    tree.knnSearch(flann::Matrix<float>(q.data(), 1, 3), indices, dists, 1,
                   flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    sum += std::sqrt(static_cast<double>(sq_dist));
  }
  return sum;
}

#ifdef CMAP_WITH_PCL
double pcl_sum(const PointCloud& data, const PointCloud& queries) {
  const auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const auto& p : data.positions) cloud->emplace_back(p.x(), p.y(), p.z());
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(cloud);
  std::vector<int> index(1);
  std::vector<float> sq_dist(1);
  double sum = 0.0;
  for (const auto& q : queries.positions) {
    tree.nearestKSearch(pcl::PointXYZ(q.x(), q.y(), q.z()), 1, index, sq_dist);
    sum += std::sqrt(static_cast<double>(sq_dist[0]));
  }
  return sum;
}
#endif

#ifdef CMAP_WITH_OPEN3D
double open3d_sum(const PointCloud& data, const PointCloud& queries) {
  open3d::geometry::PointCloud cloud;
  for (const auto& p : data.positions) cloud.points_.push_back(p.cast<double>());
  open3d::geometry::KDTreeFlann tree(cloud);
  std::vector<int> index(1);
  std::vector<double> sq_dist(1);
  double sum = 0.0;
  for (const auto& q : queries.positions) {
    tree.SearchKNN(q.cast<double>().eval(), 1, index, sq_dist);
    sum += std::sqrt(sq_dist[0]);
  }
  return sum;
}
#endif

/// What every library must agree on, up to the rounding of its distances to float.
void check_sum(benchmark::State& state, double sum, const cmap::benchmarks::TownPair& town) {
  cmap::benchmarks::expect_same_sum(sum, cmap_both_ways(town), 1e-6);
  state.SetItemsProcessed(state.iterations() * static_cast<long>(town.reference.size() + town.estimate.size()));
}

void nearest_cmap(benchmark::State& state) {
  const auto& town = cmap::benchmarks::town(state.range(0), state.range(1) != 0);
  double sum = 0.0;
  for (auto _ : state) sum = cmap_both_ways(town);
  check_sum(state, sum, town);
}

void nearest_peer(benchmark::State& state, SumOfDistances sum_of_distances) {
  const auto& town = cmap::benchmarks::town(state.range(0), state.range(1) != 0);
  double sum = 0.0;
  for (auto _ : state) {
    sum = sum_of_distances(town.reference, town.estimate) + sum_of_distances(town.estimate, town.reference);
  }
  check_sum(state, sum, town);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"points", "shuffled"})->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->MinWarmUpTime(0.001);
  for (long shuffled : {0, 1}) {
    for (long points : {1'000'000, 10'000'000}) b->Args({points, shuffled});
  }
}

BENCHMARK(nearest_cmap)->Apply(sizes);
BENCHMARK_CAPTURE(nearest_peer, flann, &flann_sum)->Apply(sizes);
#ifdef CMAP_WITH_NANOFLANN
BENCHMARK_CAPTURE(nearest_peer, nanoflann, &nanoflann_sum)->Apply(sizes);
#endif
#ifdef CMAP_WITH_PCL
BENCHMARK_CAPTURE(nearest_peer, pcl, &pcl_sum)->Apply(sizes);
#endif
#ifdef CMAP_WITH_OPEN3D
BENCHMARK_CAPTURE(nearest_peer, open3d, &open3d_sum)->Apply(sizes);
#endif

}  // namespace

BENCHMARK_MAIN();
