#pragma once

#include <cstddef>

namespace cmap {

/// What the module with PCL's FPFH features gives global registration.
struct FpfhTable {
  static constexpr const char* kModule = "fpfh";
  static constexpr int kTable = 1;
  /// xyz and normals: 3 floats a point; histograms: 33 floats a point.
  void (*features)(const float* xyz, const float* normals, std::size_t n, double radius_m, int threads,
                   float* histograms);
};

}  // namespace cmap
