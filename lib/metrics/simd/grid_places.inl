// Where points lie in a grid: the formulas are those of PhasedFrame and VoxelFrame::key.

namespace cmap::CMAP_LANES {
namespace {

/// On one axis: the voxel's key, and the part, counted from the corner of the voxel's cell.
struct AxisPlaces {
  std::int32_t key[kBlockSize], part[kBlockSize];
};

/// Whole numbers of voxels are exact in double.
void axis_places(const PartGrid& grid, std::size_t axis, const float* offsets, AxisPlaces& places) {
  const double origin = grid.origin[axis], voxel_m = grid.voxel_m, first = grid.first[axis];
  const std::int32_t local = grid.voxels_per_cell - 1, m = grid.parts_per_axis;
  double at[kBlockSize], index[kBlockSize];
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    at[i] = (origin + static_cast<double>(offsets[i])) / voxel_m;
    index[i] = __builtin_floor(at[i]);
    places.key[i] = static_cast<std::int32_t>(index[i] - first);
    places.part[i] = (places.key[i] & local) * m;
  }
  if (m == 2) {
    for (std::size_t i = 0; i < kBlockSize; ++i) places.part[i] += at[i] >= index[i] + 0.5 ? 1 : 0;
  } else if (m == 3) {
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      const double in_parts = 3.0 * (origin + static_cast<double>(offsets[i])) / voxel_m, begin = 3.0 * index[i];
      places.part[i] += (in_parts >= begin + 1.0 ? 1 : 0) + (in_parts >= begin + 2.0 ? 1 : 0);
    }
  }
}

void grid_places(const PartGrid& grid, const PointBlock& points, GridPlaces& places) {
  AxisPlaces x, y, z;
  axis_places(grid, 0, points.x, x);
  axis_places(grid, 1, points.y, y);
  axis_places(grid, 2, points.z, z);
  const std::int32_t edge = grid.edge;
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    places.x[i] = x.key[i];
    places.y[i] = y.key[i];
    places.z[i] = z.key[i];
    places.in_cell[i] = grid.first_place + (x.part[i] * edge + y.part[i]) * edge + z.part[i];
  }
}

/// Whole numbers of 32 bits as the last bits of doubles.
void axis_offsets(const PartGrid& grid, std::size_t axis, double steps_per_m, const float* points,
                  const std::int32_t* keys, std::uint32_t* offsets) {
  constexpr double kMost = 0x1p32 - 1.0, kWhole = 0x1p52;  // whose last bit is a whole one
  const double origin = grid.origin[axis], voxel_m = grid.voxel_m, first = grid.first[axis];
  double steps[kBlockSize];
  std::uint64_t bits[kBlockSize];
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const double world = origin + static_cast<double>(points[i]);
    const double rounded = (world - (first + keys[i]) * voxel_m) * steps_per_m + 0.5;
    const double not_below = rounded > 0.0 ? rounded : 0.0;
    steps[i] = __builtin_floor(not_below < kMost ? not_below : kMost) + kWhole;
  }
  __builtin_memcpy(bits, steps, sizeof(bits));
  for (std::size_t i = 0; i < kBlockSize; ++i) offsets[i] = static_cast<std::uint32_t>(bits[i]);
}

void offsets(const PartGrid& grid, double steps_per_m, const PointBlock& points, const GridPlaces& places,
             OffsetLanes& offsets) {
  axis_offsets(grid, 0, steps_per_m, points.x, places.x, offsets.x);
  axis_offsets(grid, 1, steps_per_m, points.y, places.y, offsets.y);
  axis_offsets(grid, 2, steps_per_m, points.z, places.z, offsets.z);
}

}  // namespace
}  // namespace cmap::CMAP_LANES
