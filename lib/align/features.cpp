#include "features.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cmap/core/loaded_module.hpp"
#include "cmap/core/parallel.hpp"
#include "fpfh_module.hpp"

namespace cmap {
namespace {

struct Nearest {
  std::uint32_t index = std::numeric_limits<std::uint32_t>::max();
  float sq_dist = std::numeric_limits<float>::infinity();
};

float sq_distance(const Fpfh& a, const Fpfh& b) {
  float sum[11] = {};
  for (std::size_t bin = 0; bin < 11; ++bin) {
    for (std::size_t angle = 0; angle < 33; angle += 11) {
      const float d = a[angle + bin] - b[angle + bin];
      sum[bin] += d * d;
    }
  }
  float total = 0.0f;
  for (const float s : sum) total += s;
  return total;
}

Array<Nearest> nearest_features(const Array<Fpfh>& queries, const Array<Fpfh>& data) {
  constexpr std::size_t kQueryChunk = 64;
  Array<Nearest> nearest(queries.size(), Nearest{});
  parallel_chunks(queries.size(), kQueryChunk, [&](std::size_t begin, std::size_t end) {
    for (std::uint32_t j = 0; j < data.size(); ++j) {
      for (std::size_t i = begin; i < end; ++i) {
        const float sq_dist = sq_distance(queries[i], data[j]);
        if (sq_dist < nearest[i].sq_dist) nearest[i] = {j, sq_dist};
      }
    }
  });
  return nearest;
}

}  // namespace

Array<Fpfh> fpfh_features(std::span<const Eigen::Vector3f> points, std::span<const Eigen::Vector3f> normals,
                          double radius_m) {
  static const FpfhTable& pcl = load_module<FpfhTable>(
      "libcmap_fpfh.so", "this build has no global registration (apt-get install libpcl-dev, build again)");
  Array<Fpfh> features(points.size());
  pcl.features(points.data()->data(), normals.data()->data(), points.size(), radius_m, thread_count(),
               features.data()->data());
  return features;
}

Fpfh with_flipped_normals(const Fpfh& feature) {
  Fpfh flipped = feature;
  std::reverse(flipped.begin(), flipped.begin() + 11);
  std::reverse(flipped.begin() + 22, flipped.end());
  return flipped;
}

std::vector<FeatureMatch> mutual_matches(const Array<Fpfh>& source, const Array<Fpfh>& target) {
  const Array<Nearest> of_source = nearest_features(source, target);
  const Array<Nearest> of_target = nearest_features(target, source);
  std::vector<FeatureMatch> matches;
  for (std::uint32_t i = 0; i < of_source.size(); ++i) {
    const auto [j, sq_dist] = of_source[i];
    if (j < of_target.size() && of_target[j].index == i) matches.push_back({i, j, sq_dist});
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const FeatureMatch& a, const FeatureMatch& b) { return a.sq_dist < b.sq_dist; });
  return matches;
}

}  // namespace cmap
