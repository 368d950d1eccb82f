#include "cmap/colorize/colorize.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cmap/colorize/weighted_median.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

constexpr std::size_t kPointChunk = 4096;
constexpr double kLargestDisc = 5.0;  ///< in smallest ones: farther apart, points are no surface

/// What an image saw of the points.
class ImagePass {
 public:
  ImagePass(const Surfels& surfels, const PosedImages& images, const ColorizeOptions& options)
      : surfels_(surfels), images_(images), options_(options), buffer_(images.camera, options.occlusion) {}

  std::uint64_t observe(std::size_t place, const RgbImage& image, Observations& observations) {
    const Array<ViewPoint> points =
        points_in_view(surfels_, images_.camera, images_.T_world_camera(place).inverse(), options_.occlusion);
    buffer_.fill(points);
    return ordered_sum<std::uint64_t>(points.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
      std::uint64_t n = 0;
      for (std::size_t i = begin; i < end; ++i) {
        const ViewPoint& point = points[i];
        if (!point.is_inside || buffer_.hides(point)) continue;
        const auto weight = static_cast<float>(view_weight(point, images_.camera, options_.weight));
        observations.add(point.slot, {weight, static_cast<std::uint32_t>(place), color_at(image, point.pixel)});
        ++n;
      }
      return n;
    });
  }

 private:
  const Surfels& surfels_;
  const PosedImages& images_;
  const ColorizeOptions& options_;
  DepthBuffer buffer_;
};

/// As many images as there are threads are decoded at once, and then used one after the other.
template <class Use>
void for_each_image(const PosedImages& images, Use&& use) {
  const auto batch = static_cast<std::size_t>(thread_count());
  std::vector<RgbImage> decoded;
  for (std::size_t first = 0; first < images.list.size(); first += batch) {
    decoded.assign(std::min(batch, images.list.size() - first), {});
    parallel_chunks(decoded.size(), 1, [&](std::size_t i, std::size_t) { decoded[i] = images.read(first + i); });
    for (std::size_t i = 0; i < decoded.size(); ++i) {
      report_progress("images", 0.2 + 0.7 * static_cast<double>(first + i) / static_cast<double>(images.list.size()));
      use(first + i, decoded[i]);
    }
  }
}

using Gains = Eigen::Matrix3Xf;

Eigen::Vector3f equalized(const Observation& seen, const Gains& gains) {
  const auto image = static_cast<Eigen::Index>(seen.image);
  return Eigen::Vector3f(seen.color[0], seen.color[1], seen.color[2]).cwiseQuotient(gains.col(image)) / 255.0f;
}

Eigen::Vector3f median_color(std::span<const Observation> observations, const Gains& gains,
                             std::vector<WeightedValue>& values) {
  Eigen::Vector3f color;
  for (int c = 0; c < 3; ++c) {
    values.clear();
    for (const Observation& seen : observations) values.push_back({equalized(seen, gains)[c], seen.weight});
    color[c] = weighted_median(values);
  }
  return color;
}

/// Sums over points that were seen at least twice.
struct Spread {
  double sum = 0.0, n = 0.0;
  Spread& operator+=(const Spread& other) {
    sum += other.sum;
    n += other.n;
    return *this;
  }
  void add(std::span<const Observation> observations, const Gains& gains, const Eigen::Vector3f& color) {
    if (observations.size() < 2) return;
    double distances = 0.0, weights = 0.0;
    for (const Observation& seen : observations) {
      distances += seen.weight * (equalized(seen, gains) - color).norm();
      weights += seen.weight;
    }
    sum += distances / weights;
    n += 1.0;
  }
};

/// Medians into the map's order.
Spread color_points(const Surfels& surfels, const Observations& observations, const Gains& gains,
                    Colorization& result) {
  Array<RgbF> colors(surfels.size());
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const Spread spread = ordered_sum<Spread>(surfels.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
    Spread part;
    std::vector<WeightedValue> values;
    for (std::size_t slot = begin; slot < end; ++slot) {
      const std::size_t i = surfels.original_index[slot];
      result.views[i] = observations.n_seen(slot);
      colors[i] = {kNone, kNone, kNone};
      if (observations.n_seen(slot) == 0) continue;
      const Eigen::Vector3f color = median_color(observations.of(slot), gains, values);
      part.add(observations.of(slot), gains, color);
      for (int c = 0; c < 3; ++c) colors[i][static_cast<std::size_t>(c)] = std::clamp(color[c], 0.0f, 1.0f);
    }
    return part;
  });
  result.cloud.colors = std::move(colors);
  return spread;
}

double surfel_size(const PointCloud& map, const ColorizeOptions& options) {
  if (options.surfel_m) return *options.surfel_m;
  const double spacing_m = spacing_of(map);
  return spacing_m > 0.0 ? spacing_m : SurfelOptions().least_radius_m;
}

}  // namespace

Colorization colorize(const PointCloud& map, const PosedImages& images, const ColorizeOptions& options) {
  ColorizeOptions checked = options;
  check_options(fields_of(checked), "cmap_colorize");
  check(images.camera);
  Colorization result;
  result.cloud = {map.origin, map.positions, {}, map.file_step_m};
  result.views.assign(map.size(), 0);
  result.surfel_m = surfel_size(map, options);
  report_progress("surfaces", 0.1);
  const Surfels surfels = surfels_of(map, {options.neighbors, result.surfel_m, kLargestDisc * result.surfel_m});

  Observations observations(surfels.size(), static_cast<std::size_t>(options.most_views));
  ImagePass pass(surfels, images, options);
  for_each_image(images, [&](std::size_t place, const RgbImage& image) {
    const PosedImage& posed = images.list[place];
    result.images.push_back({posed.index, posed.time_s, pass.observe(place, image, observations)});
  });

  report_progress("colors", 0.9);
  const Eigen::Matrix3Xd gains = exposure_gains_of(observations, images.list.size(), options.exposure);
  for (std::size_t place = 0; place < result.images.size(); ++place) {
    for (int c = 0; c < 3; ++c) {
      result.images[place].gain[static_cast<std::size_t>(c)] = gains(c, static_cast<Eigen::Index>(place));
    }
  }
  const Spread spread = color_points(surfels, observations, gains.cast<float>(), result);
  result.inconsistency = spread.n > 0.0 ? spread.sum / spread.n : std::numeric_limits<double>::quiet_NaN();
  result.n_seen = static_cast<std::uint64_t>(std::ranges::count_if(result.views, [](auto n) { return n > 0; }));
  if (result.n_seen == 0) {
    throw InputError(
        fmt::format("no point of the map is seen by any of {} images: other poses, another calibration or "
                    "another map?",
                    images.list.size()));
  }
  return result;
}

}  // namespace cmap
