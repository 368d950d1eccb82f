#pragma once

#include <cstdint>
#include <span>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/recon/session_points.hpp"

namespace cmap {

struct FusionOptions {
  double voxel_m = 0.05;
  double max_range_m = 0.0;    ///< points farther from their camera are left out of the map; 0: none
  double color_width = 0.1;    ///< unit RGB: colors of frames farther from their median count less
  double doubt = 0.5;          ///< voxels less sure than this share of the best around them are left out; 0: none
  int doubt_cell_voxels = 10;  ///< of the cells that are around
};

/// A map that grows frame by frame: one point for each voxel, at the confidence-weighted mean of what fell into it,
/// with a color that single frames cannot spoil. Memory is bounded by the map, whatever the number of frames. Not
/// thread-safe; the same for any number of threads.
class MapFusion {
 public:
  /// Voxels are anchored at the world's origin. Whoever adds points keeps to max_range_m. Throws UsageError for
  /// options.
  explicit MapFusion(const FusionOptions& options);

  /// Adds one frame's points, placed by T_world_camera_metric * scale * p.
  void add(const FramePoints& points, const Eigen::Isometry3d& T_world_camera, double scale);

  /// The map: float colors, voxels in the order in which they were first seen. A color is the mean of at most
  /// kColorsPerVoxel frames' mean colors, weighted by Cauchy's kernel about their median.
  /// Left out are voxels whose mean confidence is below `doubt` times the mean of the best cell around (its own and the
  /// 26 beside it): what was seen from far away, where something better was seen from near.
  PointCloud finish() const;

  std::size_t size() const { return voxels_.entries().size(); }
  std::uint64_t points_added() const { return n_added_; }

  static constexpr int kColorsPerVoxel = 8;

 private:
  struct Voxel {
    Eigen::Vector3f offset_sum = Eigen::Vector3f::Zero();  ///< from the voxel's corner, weighted, m
    float weight = 0.0f;                                   ///< sum of confidences
    std::uint32_t n = 0;                                   ///< points
    std::array<Rgb8, kColorsPerVoxel> colors;              ///< of frames
    std::uint32_t frame = 0;                               ///< that the sums below are of; 0: none
    std::array<float, 3> color_sum{};
    std::uint16_t n_in_frame = 0;
    std::uint16_t n_frames = 0;
  };

  Array<std::uint8_t> trusted() const;
  static void close_frame(Voxel& voxel);
  RgbF color_of(Voxel voxel) const;

  FusionOptions options_;
  std::uint32_t frame_ = 0;
  std::uint64_t n_added_ = 0;
  VoxelMap<Voxel> voxels_;
};

}  // namespace cmap
