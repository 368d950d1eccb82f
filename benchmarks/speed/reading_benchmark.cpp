// Reading a binary PLY and PCD of the town's reference: cmap, PCL, and the plain read() that nothing can beat.

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include "town_pair.hpp"

#ifdef CMAP_WITH_PCL
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#endif

namespace {

std::string ply_path(long points) { return (cmap::benchmarks::town_folder(points) / "reference.ply").string(); }

/// The same cloud as PCD, written beside it once.
std::string pcd_path(long points) {
  const std::string path = (cmap::benchmarks::town_folder(points) / "reference.pcd").string();
  if (!std::filesystem::exists(path)) cmap::write_pcd(path, cmap::read_point_cloud(ply_path(points)).cloud);
  return path;
}

using PathOf = std::string (*)(long points);

void set_bytes(benchmark::State& state, const std::string& path) {
  state.SetBytesProcessed(state.iterations() * static_cast<long>(std::filesystem::file_size(path)));
}

void read_plain(benchmark::State& state, PathOf path_of) {
  const std::string path = path_of(state.range(0));
  std::vector<char> block(1 << 20);
  for (auto _ : state) {
    const int file = open(path.c_str(), O_RDONLY);
    while (read(file, block.data(), block.size()) > 0) benchmark::DoNotOptimize(block.data());
    close(file);
  }
  set_bytes(state, path);
}

void read_cmap(benchmark::State& state, PathOf path_of, bool sha256) {
  const std::string path = path_of(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(cmap::read_point_cloud(path, {.sha256 = sha256}));
  set_bytes(state, path);
}

#ifdef CMAP_WITH_PCL
void read_pcl(benchmark::State& state, PathOf path_of, bool ply) {
  const std::string path = path_of(state.range(0));
  for (auto _ : state) {
    pcl::PointCloud<pcl::PointXYZRGB> cloud;
    const int status = ply ? pcl::io::loadPLYFile(path, cloud) : pcl::io::loadPCDFile(path, cloud);
    if (status < 0) throw std::runtime_error("PCL cannot read " + path);
    benchmark::DoNotOptimize(cloud.points.data());
  }
  set_bytes(state, path);
}
#endif

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"points"})->Unit(benchmark::kMillisecond)->Arg(1'000'000)->Arg(10'000'000);
}

BENCHMARK_CAPTURE(read_plain, ply, &ply_path)->Apply(sizes);
BENCHMARK_CAPTURE(read_cmap, ply, &ply_path, false)->Apply(sizes);
BENCHMARK_CAPTURE(read_cmap, ply_with_sha256, &ply_path, true)->Apply(sizes);
BENCHMARK_CAPTURE(read_cmap, pcd, &pcd_path, false)->Apply(sizes);
#ifdef CMAP_WITH_PCL
BENCHMARK_CAPTURE(read_pcl, ply, &ply_path, true)->Apply(sizes);
BENCHMARK_CAPTURE(read_pcl, pcd, &pcd_path, false)->Apply(sizes);
#endif

}  // namespace

BENCHMARK_MAIN();
