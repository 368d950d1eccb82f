// The hall of balm_hall with its loops closed.
//
//     CMAP_DATA_DIR=DATA loops_hall_benchmark FOLDER
//
// Into FOLDER: before.ply and after.ply, all keyframes by the published and by the closed poses; loops.json. To stdout
// what was found.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cmap/io/point_cloud_file.hpp"
#include "cmap/lio/loop_closure.hpp"
#include "lio/balm_hall.hpp"

namespace cmap::benchmark {
namespace {

PointCloud fused(const std::vector<Keyframe>& keyframes, const std::vector<Eigen::Isometry3d>& poses) {
  PointCloud cloud;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const Eigen::Isometry3f T = poses[k].cast<float>();
    for (const Eigen::Vector3f& p : keyframes[k].points_body) cloud.positions.push_back(T * p);
  }
  return cloud;
}

void run(const std::filesystem::path& folder) {
  const std::vector<Keyframe> keyframes = test::balm_hall_keyframes();
  std::vector<Eigen::Isometry3d> before;
  for (const Keyframe& keyframe : keyframes) before.push_back(keyframe.T_world_body);
  const LoopOptions options = loop_options_for(keyframes);
  const auto start = std::chrono::steady_clock::now();
  const LoopClosure closure = close_loops(keyframes, options);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  write_ply(folder / "before.ply", fused(keyframes, before));
  write_ply(folder / "after.ply", fused(keyframes, closure.poses));
  std::ofstream(folder / "loops.json") << loops_json(closure, keyframes, options).dump(1) << "\n";
  std::cout << fmt::format("{} submaps, {} candidates, {} loops in {:.1f} s; poses moved by up to {:.3f} m\n",
                           closure.n_submaps, closure.candidates.size(), closure.n_loops, took.count(),
                           closure.largest_change_m);
}

}  // namespace
}  // namespace cmap::benchmark

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: loops_hall_benchmark FOLDER\n";
    return 2;
  }
  std::filesystem::create_directories(argv[1]);
  cmap::benchmark::run(argv[1]);
}
