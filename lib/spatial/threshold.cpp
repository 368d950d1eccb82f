#include "cmap/spatial/threshold.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cmap/spatial/bvh.hpp"

namespace cmap {

double float_step(float offset) {
  const float magnitude = std::abs(offset);
  return static_cast<double>(std::nextafter(magnitude, std::numeric_limits<float>::infinity()) - magnitude);
}

float largest_offset(const Bvh& points) {
  const BoxNode& root = points.boxes.back().front();
  float largest = 0.0f;
  for (std::size_t c = 0; c < kBlockSize; ++c) {
    if (root.min_x[c] > root.max_x[c]) continue;  // no child
    for (float v : {root.min_x[c], root.min_y[c], root.min_z[c], root.max_x[c], root.max_y[c], root.max_z[c]}) {
      largest = std::max(largest, std::abs(v));
    }
  }
  return largest;
}

bool is_within(double sq_dist, double threshold_m, double steps, float largest_offset) {
  return std::sqrt(sq_dist) <= threshold_m + steps * float_step(largest_offset);
}

}  // namespace cmap
