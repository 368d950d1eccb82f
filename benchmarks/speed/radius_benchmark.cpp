// Radius work: local color recall and mean map entropy against the same on nanoflann's radius search. Indices are built
// and nearest neighbors known beforehand on both sides.

#include <benchmark/benchmark.h>

#include <Eigen/LU>

#include "cmap/geometry/color.hpp"
#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/local_color_recall.hpp"
#include "cmap/metrics/metric_sums.hpp"
#include "town_pair.hpp"

#ifdef CMAP_WITH_NANOFLANN
#include "nanoflann_index.hpp"
#endif

namespace {

using cmap::PointCloud;

constexpr double kRadius_m = 0.5;
constexpr double kEntropyRadius_m = 0.2;

/// The stricter, the farther one has to look for the right color.
double tau_of(const benchmark::State& state) { return 0.01 * static_cast<double>(state.range(1)); }

cmap::MapPair pair_of(const cmap::benchmarks::TownPair& town) {
  cmap::MapPair pair{cmap::IndexedMap(town.reference), cmap::IndexedMap(town.estimate), {}, {}};
  pair.nearest_in_estimate = cmap::find_nearest(pair.estimate.index, pair.reference.index.points);
  return pair;
}

void recall_cmap(benchmark::State& state) {
  const cmap::MapPair pair = pair_of(cmap::benchmarks::town(state.range(0), false));
  std::uint64_t n_recalled = 0;
  for (auto _ : state) {
    const auto classes = cmap::find_recall(pair, {tau_of(state), kRadius_m, false}).classes;
    n_recalled = static_cast<std::uint64_t>(std::ranges::count(classes, cmap::RecallClass::kRecalled));
  }
  state.counters["recalled"] = static_cast<double>(n_recalled);
}

void entropy_cmap(benchmark::State& state) {
  const cmap::IndexedMap map(cmap::benchmarks::town(state.range(0), false).estimate);
  cmap::MetricOptions options;
  options.mme_radius_m = kEntropyRadius_m;
  double n = 0.0;
  for (auto _ : state) {
    cmap::MetricInputs inputs(options, map);
    std::vector<cmap::Warning> warnings;
    n = *cmap::measure(cmap::catalog::mean_map_entropy, inputs, warnings).number("n");
  }
  state.counters["valid"] = n;
}

#ifdef CMAP_WITH_NANOFLANN

/// A result set that stops the search at the first neighbor of the right color.
class FirstRightColor {
 public:
  FirstRightColor(const PointCloud& cloud, const cmap::RgbF& color, float limit)
      : cloud_(cloud), color_(color), limit_(limit) {}
  bool found() const { return found_; }

  // nanoflann's interface
  bool full() const { return true; }
  std::size_t size() const { return found_ ? 1 : 0; }
  float worstDist() const { return static_cast<float>(kRadius_m * kRadius_m); }
  bool addPoint(float sq_dist, std::uint32_t index) {
    if (sq_dist > worstDist()) return true;
    const cmap::RgbF c = cmap::rgb_255(cloud_.colors, index);
    const float dr = c[0] - color_[0], dg = c[1] - color_[1], db = c[2] - color_[2];
    found_ = dr * dr + dg * dg + db * db <= limit_;
    return !found_;
  }

 private:
  const PointCloud& cloud_;
  cmap::RgbF color_;
  float limit_;
  bool found_ = false;
};

void recall_nanoflann_early_exit(benchmark::State& state) {
  const auto& town = cmap::benchmarks::town(state.range(0), false);
  const cmap::benchmarks::NanoflannIndex index(town.estimate);
  const auto limit = static_cast<float>(std::pow(3.0 * tau_of(state) * 255.0, 2));
  std::uint64_t n_recalled = 0;
  for (auto _ : state) {
    n_recalled = 0;
    for (std::size_t j = 0; j < town.reference.size(); ++j) {
      FirstRightColor result(town.estimate, cmap::rgb_255(town.reference.colors, j), limit);
      index.tree.findNeighbors(result, town.reference.positions[j].data(), nanoflann::SearchParams());
      n_recalled += result.found() ? 1 : 0;
    }
  }
  state.counters["recalled"] = static_cast<double>(n_recalled);
}

void entropy_nanoflann(benchmark::State& state) {
  const auto& cloud = cmap::benchmarks::town(state.range(0), false).estimate;
  const cmap::benchmarks::NanoflannIndex index(cloud);
  std::uint64_t n_valid = 0;
  for (auto _ : state) {
    n_valid = 0;
    std::vector<std::pair<std::uint32_t, float>> found;
    for (const auto& q : cloud.positions) {
      index.tree.radiusSearch(q.data(), static_cast<float>(kEntropyRadius_m * kEntropyRadius_m), found,
                              nanoflann::SearchParams(32, 0, false));
      if (found.size() < 11) continue;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      Eigen::Matrix3d sum_sq = Eigen::Matrix3d::Zero();
      for (const auto& [i, sq_dist] : found) {
        const Eigen::Vector3d d = cloud.positions[i].cast<double>() - q.cast<double>();
        sum += d;
        sum_sq += d * d.transpose();
      }
      const auto n = static_cast<double>(found.size() - 1);
      n_valid += ((sum_sq - sum * sum.transpose() / n) / (n - 1.0)).determinant() > 0.0 ? 1 : 0;
    }
  }
  state.counters["valid"] = static_cast<double>(n_valid);
}

#endif

void sizes_and_taus(benchmark::internal::Benchmark* b) {
  b->ArgNames({"points", "percent_tau"})->Unit(benchmark::kSecond)->MeasureProcessCPUTime()->MinWarmUpTime(0.001);
  for (long percent_tau : {10, 3, 1}) {
    for (long points : {1'000'000, 10'000'000}) b->Args({points, percent_tau});
  }
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"points"})
      ->Unit(benchmark::kSecond)
      ->MeasureProcessCPUTime()
      ->MinWarmUpTime(0.001)
      ->Arg(1'000'000)
      ->Arg(10'000'000);
}

BENCHMARK(recall_cmap)->Apply(sizes_and_taus);
BENCHMARK(entropy_cmap)->Apply(sizes);
#ifdef CMAP_WITH_NANOFLANN
BENCHMARK(recall_nanoflann_early_exit)->Apply(sizes_and_taus);
BENCHMARK(entropy_nanoflann)->Apply(sizes);
#endif

}  // namespace

BENCHMARK_MAIN();
