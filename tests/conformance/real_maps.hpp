#pragma once

// Real maps for the tests; they lie outside the repository: $CMAP_SHARED_DIR, or ../shared beside it.

#include "cmap/eval/configuration.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "conformance/records.hpp"

namespace cmap::test {

inline std::filesystem::path shared_folder() {
  if (const char* folder = std::getenv("CMAP_SHARED_DIR")) return folder;
  return source_folder() / "../shared";
}

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real data: " << (path) << " is missing; set CMAP_SHARED_DIR"

inline EvaluationOptions options_of(const Json& config) {
  EvaluationOptions options;
  apply_config(options, config.dump(), "golden test");
  return options;
}

struct Pair {
  PointCloud reference;
  PointCloud estimate;
};

inline const Json kTumOptions{{"metrics", {"color", "geometry", "distribution"}},
                              {"thresholds", {0.2, 0.1, 0.05, 0.02, 0.01}},
                              {"overlap-distance", 0.2},
                              {"lcr-radius", 0.05},
                              {"ccs-voxel", 0.05},
                              {"ccs-singletons", "exclude"},
                              {"awd-voxel", 0.5},
                              {"mme-radius", 0.05},
                              {"as", {"mapeval", "open3d", "cloudcompare", "mpeg"}}};

inline Pair read_tum() {
  const std::filesystem::path folder = shared_folder() / "data/tum_fr1";
  return {read_point_cloud(folder / "reference.ply").cloud, read_point_cloud(folder / "estimate.ply").cloud};
}

}  // namespace cmap::test
