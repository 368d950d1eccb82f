#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "cmap/colorize/depth_buffer.hpp"
#include "cmap/colorize/exposure.hpp"
#include "cmap/colorize/posed_images.hpp"
#include "cmap/colorize/surfels.hpp"
#include "cmap/core/options.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// What a view of a point counts for: angle x distance x border, each in (0,1].
///     angle     max(|cos|, least_cosine)^angle_power               cos of the ray and the point's normal
///     distance  (1 + (range / near_range_m)^2)^(-range_power / 2)  powers of 1 and 2: pixels on the surface
///     border    from least_border_weight at the image's edge to 1 at border_share of its smaller side
struct ViewWeightOptions {
  double angle_power = 1.0;
  double least_cosine = 0.1;
  double range_power = 2.0;
  double near_range_m = 2.0;
  double border_share = 0.1;
  double least_border_weight = 0.1;
};

struct ColorizeOptions {
  std::optional<double> surfel_m;  ///< how fine the map is: the smallest disc; none: spacing_of() it
  int neighbors = 12;              ///< of a point, for its plane
  int most_views = 16;             ///< kept of a point: those of the largest weights
  OcclusionOptions occlusion;
  ViewWeightOptions weight;
  ExposureOptions exposure;
};

/// All of them by name.
OptionFields fields_of(ColorizeOptions& options);

/// The weight of a view.
double view_weight(const ViewPoint& point, const CameraModel& camera, const ViewWeightOptions& options);

/// An image at a pixel, between its four pixels around (bilinear), rounded; at the border the pixels there.
Rgb8 color_at(const RgbImage& image, const Eigen::Vector2f& pixel);

/// What became of an image.
struct ColoredFrom {
  std::size_t index = 0;  ///< in the capture's table
  double time_s = 0.0;
  std::uint64_t n_seen = 0;             ///< points
  std::array<double, 3> gain{1, 1, 1};  ///< of its exposure, by channel
};

/// A map with colors from images.
struct Colorization {
  PointCloud cloud;            ///< the map's points in their order; colors in [0,1], NaN where no image saw the point
  Array<std::uint32_t> views;  ///< of each point
  std::vector<ColoredFrom> images;
  std::uint64_t n_seen = 0;  ///< points with a color
  double surfel_m = 0.0;     ///< that was used
  /// Mean over points of at least two views of the weighted mean distance of their observed colors, gains taken off,
  /// from the point's own, as a length in unit RGB: what calibration, clock and exposure leave. NaN without such
  /// points.
  double inconsistency = 0.0;
};

/// Colors the points of a map. Each image is read once; as many as there are threads are in memory at a time. For each:
/// the discs before the camera (points_in_view()), their z-buffer (DepthBuffer), and a weighted observation of every
/// point that it does not hide. Then gains from the points that images share (exposure_gains_of()), and for each point
/// and channel the weighted median of the observations, divided by their images' gains (weighted_median()). Memory:
/// about 60 + 12 most_views bytes a point. Throws UsageError for options out of range, InputError as the images' reader
/// does, or where no image sees any point; std::invalid_argument for an empty map. Thread-safe; the same for any number
/// of threads.
Colorization colorize(const PointCloud& map, const PosedImages& images, const ColorizeOptions& options = {});

}  // namespace cmap
