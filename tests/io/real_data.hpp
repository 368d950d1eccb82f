#pragma once

#include <cstdlib>
#include <filesystem>

#include "io/io_testing.hpp"

namespace cmap::testing {

/// Public recordings outside the repository: $CMAP_DATA_DIR, or shared/data beside it.
class RealData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const char* folder = std::getenv("CMAP_DATA_DIR")) {
      folder_ = folder;
    } else if (const char* source = std::getenv("CMAP_SOURCE_DIR")) {
      folder_ = std::filesystem::path(source) / "../shared/data";
    }
    if (folder_.empty() || !std::filesystem::is_directory(folder_)) {
      GTEST_SKIP() << "no real data: set CMAP_DATA_DIR";
    }
  }
  PointCloudFile read(std::string_view name) const { return read_point_cloud(folder_ / name); }

  std::filesystem::path folder_;
};

}  // namespace cmap::testing
