// A drive of 3 km through the simulated town that comes back along its streets in the other direction, by an odometry
// that drifts: what close_loops() finds and what becomes of the poses, and descriptors beside Scan Context.
//
//     loops_town_benchmark SEED FOLDER
//
// Into FOLDER: loops.json, curve_METHOD.csv; to stdout one JSON object.

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "cmap/lio/loop_closure.hpp"
#include "lio/loop_town.hpp"
#include "loops/ring_descriptor.hpp"
#include "loops/scan_context.hpp"
#include "loops/submaps.hpp"
#include "place_recognition.hpp"

namespace cmap::benchmark {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSamePlace_m = 10.0;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Five streets from end to end, and back along three of them and most of what connects them.
test::LoopDriveOptions long_drive(std::uint64_t seed) {
  test::LoopDriveOptions options;
  options.town.seed = options.seed = seed;
  options.town.blocks_x = options.town.blocks_y = 6;
  options.heading_deg_per_m = 0.0025;  // with the scale, 0.3 to 0.5 % of the path
  options.scale = 0.005;
  options.crossings = {{0, 0}, {4, 0}, {4, 1}, {0, 1}, {0, 2}, {4, 2}, {4, 3}, {0, 3},
                       {0, 4}, {4, 4}, {4, 2}, {0, 2}, {0, 1}, {4, 1}, {4, 0}, {0, 0}};
  return options;
}

/// The drive, its submaps, and which of them truly show the same place.
struct Case {
  explicit Case(std::uint64_t seed)
      : drive(test::simulated_drive(long_drive(seed))),
        paths_m(path_lengths_m(drive.keyframes)),
        submaps(submaps_of(drive.keyframes, paths_m, options)) {}

  double true_distance_m(std::size_t a, std::size_t b) const {
    return (drive.truth[a].translation() - drive.truth[b].translation()).norm();
  }
  bool may_ask(std::size_t from, std::size_t to) const {
    return submaps[to].path_m - submaps[from].path_m >= options.min_path_m;
  }
  bool is_same(std::size_t from, std::size_t to) const {
    return may_ask(from, to) && true_distance_m(submaps[from].center, submaps[to].center) < kSamePlace_m;
  }

  LoopOptions options;
  test::LoopDrive drive;
  std::vector<double> paths_m;
  std::vector<Submap> submaps;
};

/// Descriptors of every submap, and of the single scan at its center.
struct Descriptors {
  explicit Descriptors(const Case& c) {
    for (auto* all : {&rings, &scan_rings}) all->resize(c.submaps.size());
    for (auto* all : {&contexts, &scan_contexts}) all->resize(c.submaps.size());
    shifted.resize(c.submaps.size());
    parallel_chunks(c.submaps.size(), 1, [&](std::size_t i, std::size_t) {
      Submap scan = c.submaps[i];
      const PointCloud submap = points_of(scan, c.drive.keyframes, c.options.voxel_m);
      describe(submap, c.options, rings[i], contexts[i]);
      shifted[i] = sideways(submap);
      scan.first = scan.last = scan.center;
      describe(points_of(scan, c.drive.keyframes, c.options.voxel_m), c.options, scan_rings[i], scan_contexts[i]);
    });
  }
  static void describe(const PointCloud& points, const LoopOptions& options, RingDescriptor& ring,
                       ScanContext& context) {
    const double ground_m = ground_height_m(points);
    ring = ring_descriptor(birds_eye(points, ground_m, options.reach_m));
    context = scan_context(points, ground_m);
  }
  /// Contexts as if seen from other lanes, as Scan Context++ (Kim, Choi and Kim, T-RO 2022) makes up for its shifts.
  static std::vector<ScanContext> sideways(PointCloud points) {
    const double ground_m = ground_height_m(points);
    std::vector<ScanContext> contexts;
    for (Eigen::Vector3f& p : points.positions) p.y() -= 4.0F;
    for (int lane = 0; lane < 5; ++lane) {
      contexts.push_back(scan_context(points, ground_m));
      for (Eigen::Vector3f& p : points.positions) p.y() += 2.0F;
    }
    return contexts;
  }
  std::vector<RingDescriptor> rings, scan_rings;
  std::vector<ScanContext> contexts, scan_contexts;
  std::vector<std::vector<ScanContext>> shifted;  ///< by 4 m to either side, in steps of 2
};

Json curve_json(const Curve& curve) {
  return {
      {"recall_at_full_precision", curve.recall_at_full_precision}, {"best_f1", curve.best_f1}, {"area", curve.area}};
}

void write_curve(const Curve& curve, const std::filesystem::path& path) {
  std::ofstream file(path);
  file << "threshold,precision,recall\n";
  for (const Curve::Point& p : curve.points)
    fmt::print(file, "{:.6f},{:.6f},{:.6f}\n", p.threshold, p.precision, p.recall);
}

Json descriptors_json(const Case& c, const std::filesystem::path& folder) {
  const Descriptors all(c);
  const auto rings = [](const std::vector<RingDescriptor>& of) {
    return [&of](std::size_t from, std::size_t to) { return best_turn(of[to], of[from]).similarity; };
  };
  const auto contexts = [](const std::vector<ScanContext>& of) {
    return [&of](std::size_t from, std::size_t to) { return -best_turn(of[to], of[from]).distance; };
  };
  const auto of_lanes = [&all](std::size_t from, std::size_t to) {
    double best = -1.0;
    for (const ScanContext& seen : all.shifted[from])
      best = std::max(best, -best_turn(all.contexts[to], seen).distance);
    return best;
  };
  const std::vector<std::pair<std::string, std::function<double(std::size_t, std::size_t)>>> methods{
      {"ring_submaps", rings(all.rings)},
      {"ring_scans", rings(all.scan_rings)},
      {"scan_context_submaps", contexts(all.contexts)},
      {"scan_context_submaps_lanes", of_lanes},
      {"scan_context_scans", contexts(all.scan_contexts)}};
  Json json;
  for (const auto& [name, score] : methods) {
    const double start_s = seconds();
    const Curve curve = curve_of(answers_by(
        c.submaps.size(), [&](std::size_t a, std::size_t b) { return c.may_ask(a, b); },
        [&](std::size_t a, std::size_t b) { return c.is_same(a, b); }, score));
    json[name] = curve_json(curve);
    json[name]["compare_s"] = seconds() - start_s;
    write_curve(curve, folder / ("curve_" + name + ".csv"));
  }
  return json;
}

/// Of accepted loops: whether they are right, and which places have one.
Json loops_result(const Case& c, const LoopClosure& closure) {
  constexpr double kRight_m = 0.5, kRight_deg = 2.0;
  std::size_t n_right = 0, n_revisits = 0, n_found = 0;
  double worst_m = 0.0;
  std::map<std::size_t, bool> has_loop;
  std::map<std::string, int> by_source;
  for (const LoopCandidate& loop : closure.candidates) {
    if (!loop.accepted) continue;
    const Eigen::Isometry3d off =
        (c.drive.truth[loop.from].inverse() * c.drive.truth[loop.to]).inverse() * loop.T_from_to;
    const double off_m = off.translation().norm();
    worst_m = std::max(worst_m, off_m);
    n_right += off_m < kRight_m && Eigen::AngleAxisd(off.linear()).angle() < kRight_deg * std::numbers::pi / 180.0;
    has_loop[loop.to] = true;
    ++by_source[std::string(name_of(loop.source, loop_source_names()))];
  }
  for (std::size_t to = 0; to < c.submaps.size(); ++to) {
    bool is_revisit = false;
    for (std::size_t from = 0; from < to; ++from) is_revisit |= c.is_same(from, to);
    n_revisits += is_revisit;
    n_found += is_revisit && has_loop.contains(c.submaps[to].center);
  }
  return {
      {"candidates", closure.candidates.size()},
      {"accepted", closure.n_loops},
      {"right", n_right},
      {"precision", closure.n_loops > 0 ? static_cast<double>(n_right) / static_cast<double>(closure.n_loops) : 1.0},
      {"revisits", n_revisits},
      {"found", n_found},
      {"recall", static_cast<double>(n_found) / static_cast<double>(n_revisits)},
      {"worst_loop_error_m", worst_m},
      {"accepted_by_source", by_source}};
}

Json poses_result(const Case& c, const std::vector<Eigen::Isometry3d>& poses) {
  double worst_m = 0.0, sq_sum = 0.0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double off_m = (poses[k].translation() - c.drive.truth[k].translation()).norm();
    worst_m = std::max(worst_m, off_m);
    sq_sum += off_m * off_m;
  }
  const auto end = [](const std::vector<Eigen::Isometry3d>& p) {
    return (p.front().inverse() * p.back()).translation().eval();
  };
  return {{"end_to_start_m", (end(poses) - end(c.drive.truth)).norm()},
          {"rms_m", std::sqrt(sq_sum / static_cast<double>(poses.size()))},
          {"worst_m", worst_m}};
}

Json run(std::uint64_t seed, const std::filesystem::path& folder) {
  const double start_s = seconds();
  const Case c(seed);
  std::vector<Eigen::Isometry3d> odometry;
  for (const Keyframe& keyframe : c.drive.keyframes) odometry.push_back(keyframe.T_world_body);
  const double simulated_s = seconds();
  const LoopClosure closure = close_loops(c.drive.keyframes, c.options);
  const double closed_s = seconds();
  std::ofstream(folder / "loops.json") << loops_json(closure, c.drive.keyframes, c.options).dump(1) << "\n";
  return {{"seed", seed},
          {"path_m", c.paths_m.back()},
          {"keyframes", odometry.size()},
          {"submaps", closure.n_submaps},
          {"simulation_s", simulated_s - start_s},
          {"loops_s", closed_s - simulated_s},
          {"loops", loops_result(c, closure)},
          {"odometry", poses_result(c, odometry)},
          {"closed", poses_result(c, closure.poses)},
          {"descriptors", descriptors_json(c, folder)}};
}

}  // namespace
}  // namespace cmap::benchmark

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: loops_town_benchmark SEED FOLDER\n";
    return 2;
  }
  std::filesystem::create_directories(argv[2]);
  std::cout << cmap::benchmark::run(std::stoull(argv[1]), argv[2]).dump(1) << "\n";
}
