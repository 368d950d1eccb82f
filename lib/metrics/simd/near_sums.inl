// What local_variations.cpp sums around a voxel.

namespace cmap::CMAP_LANES {
namespace {

constexpr std::size_t kAtOnce = RowsOfVoxels::kAtOnce;
using Values [[gnu::vector_size(kAtOnce * sizeof(double))]] = double;  // GCC's loops would go across stretches
using Bits [[gnu::vector_size(kAtOnce * sizeof(double))]] = std::int64_t;

[[gnu::always_inline]] inline void load(Values& values, const double* from) {
  __builtin_memcpy(&values, from, sizeof(values));
}

[[gnu::always_inline]] inline double total(const Values& values) {
  double all = 0.0;
  for (std::size_t i = 0; i < kAtOnce; ++i) all += values[i];
  return all;
}

NearSums near_sums(const RowsOfVoxels& voxels, const Stretch* stretches, std::size_t n_stretches, std::size_t center,
                   double radius) {
  const double y = voxels.y[center], z = voxels.z[center], center_m = voxels.distance_m[center];
  const double low_y = y - radius, high_y = y + radius, low_z = z - radius, high_z = z + radius;
  Values n{}, sum{}, sum_sq{}, at_y, at_z, distance_m;
  for (std::size_t k = 0; k < n_stretches; ++k) {
    for (std::size_t i = stretches[k].begin; i < stretches[k].end; i += kAtOnce) {
      load(at_y, voxels.y + i);
      load(at_z, voxels.z + i);
      load(distance_m, voxels.distance_m + i);
      const Bits is_near = (at_y >= low_y) & (at_y <= high_y) & (at_z >= low_z) & (at_z <= high_z);
      const Values difference = is_near ? distance_m - center_m : Values{};
      n += is_near ? Values{} + 1.0 : Values{};
      sum += difference;
      sum_sq += difference * difference;
    }
  }
  return {total(n), total(sum), total(sum_sq)};
}

}  // namespace
}  // namespace cmap::CMAP_LANES
