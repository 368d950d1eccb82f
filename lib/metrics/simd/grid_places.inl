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

}  // namespace
}  // namespace cmap::CMAP_LANES
