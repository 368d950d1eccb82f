#pragma once

// The clouds of the benchmarks: towns of benchmarks/make_town.py, as files.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include "cmap/io/point_cloud_file.hpp"

namespace cmap::benchmarks {

struct TownPair {
  PointCloud reference;
  PointCloud estimate;
};

/// $CMAP_TOWNS/<points>, made by `benchmarks/make_town.py --points <points> --out $CMAP_TOWNS/<points>`.
inline std::filesystem::path town_folder(long points) {
  const char* towns = std::getenv("CMAP_TOWNS");
  const std::filesystem::path folder =
      std::filesystem::path(towns == nullptr ? "towns" : towns) / std::to_string(points);
  if (!std::filesystem::exists(folder)) {
    throw std::runtime_error(
        fmt::format("{0} is missing: benchmarks/make_town.py --points {1} --out {0}", folder.string(), points));
  }
  return folder;
}

inline void shuffle(PointCloud& cloud, unsigned seed) {
  std::vector<std::size_t> order(cloud.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937_64(seed));
  PointCloud shuffled = cloud;
  auto& colors = std::get<Array<Rgb8>>(shuffled.colors);
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.positions[i] = cloud.positions[order[i]];
    colors[i] = std::get<Array<Rgb8>>(cloud.colors)[order[i]];
  }
  cloud = std::move(shuffled);
}

/// A town in the order of its files (tiles, as scanned) or shuffled; the last one stays in memory.
inline const TownPair& town(long points, bool shuffled) {
  static std::map<std::pair<long, bool>, TownPair> loaded;
  const std::pair key(points, shuffled);
  if (!loaded.contains(key)) {
    loaded.clear();
    TownPair pair{read_point_cloud(town_folder(points) / "reference.ply").cloud,
                  read_point_cloud(town_folder(points) / "estimate.ply").cloud};
    if (shuffled) {
      shuffle(pair.reference, 1);
      shuffle(pair.estimate, 2);
    }
    loaded[key] = std::move(pair);
  }
  return loaded[key];
}

/// Sum of distances: what every library must agree on.
inline void expect_same_sum(double sum, double expected, double tolerance) {
  if (std::abs(sum - expected) > tolerance * expected) {
    throw std::runtime_error(fmt::format("the libraries disagree: {} and {}", sum, expected));
  }
}

}  // namespace cmap::benchmarks
