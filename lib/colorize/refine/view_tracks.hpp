#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "cmap/colorize/refine_extrinsic.hpp"
#include "refine/gray_pyramid.hpp"

namespace cmap {

/// An image of the chosen ones, in memory.
struct KeptImage {
  std::size_t place = 0;  ///< in the list of images
  GrayPyramid gray;
  float gain = 1.0f;
};

/// Images in runs that share points, the runs spread over the way; of those that moved.
std::vector<std::size_t> chosen_images(const PosedImages& images, const RefineOptions& options);

/// A point as one image has it.
struct TrackView {
  Eigen::Vector3d position_lidar;  ///< at the image's time
  std::uint32_t image = 0;         ///< of the kept ones
  float weight = 0.0f;
};

/// The views of some points, one point after the other.
struct ViewTracks {
  std::vector<TrackView> views;
  std::vector<std::size_t> starts{0};  ///< of points; one more at the end

  std::size_t n_points() const { return starts.size() - 1; }
  std::span<const TrackView> of(std::size_t point) const {
    return {views.data() + starts[point], starts[point + 1] - starts[point]};
  }
};

/// Which kept images see which points, with this extrinsic; sets the images' gains.
ViewTracks make_tracks(const Surfels& surfels, const PosedImages& images, std::vector<KeptImage>& kept,
                       const Eigen::Isometry3d& T_lidar_camera, const ColorizeOptions& options,
                       const RefineOptions& refine);

}  // namespace cmap
