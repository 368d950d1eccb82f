#pragma once

#include <cstdint>
#include <span>

#include "cmap/geometry/point_cloud.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "cmap/recon/session_points.hpp"

namespace cmap {

/// A map that grows frame by frame: one point for each voxel, at the confidence-weighted mean of what fell into it,
/// with a color that single frames cannot spoil. Memory is bounded by the map, whatever the number of frames. Not
/// thread-safe; the same for any number of threads.
class MapFusion {
 public:
  /// Voxels are anchored at the world's origin.
  explicit MapFusion(double voxel_m);

  /// Adds one frame's points, placed by T_world_camera_metric * scale * p.
  void add(const FramePoints& points, const Eigen::Isometry3d& T_world_camera, double scale);

  /// The map: float colors, voxels in the order in which they were first seen. A color is the mean of at most
  /// kColorsPerVoxel frames' mean colors, weighted by Cauchy's kernel about their median (width 0.1 unit RGB).
  /// Left out are voxels whose mean confidence is below `doubt` times the mean of the best cell around (cells of
  /// kDoubtCell voxels, its own and the 26 beside it): what was seen from far away, where something better was seen
  /// from near. 0: all stay.
  PointCloud finish(double doubt = 0.0) const;

  std::size_t size() const { return voxels_.entries().size(); }
  std::uint64_t points_added() const { return n_added_; }

  static constexpr int kColorsPerVoxel = 8;
  static constexpr int kDoubtCell = 10;

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

  Array<std::uint8_t> trusted(double doubt) const;
  static void close_frame(Voxel& voxel);
  static RgbF color_of(Voxel voxel);

  double voxel_m_;
  std::uint32_t frame_ = 0;
  std::uint64_t n_added_ = 0;
  VoxelMap<Voxel> voxels_;
};

}  // namespace cmap
