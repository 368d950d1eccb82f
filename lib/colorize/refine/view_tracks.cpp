#include "refine/view_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cmap/core/execution.hpp"
#include "cmap/geometry/rotation.hpp"

namespace cmap {
namespace {

constexpr std::size_t kCandidatesPerPoint = 8;

struct Sighting {
  std::uint32_t candidate;
  TrackView view;
};

}  // namespace

std::vector<std::size_t> chosen_images(const PosedImages& images, const RefineOptions& options) {
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < images.list.size(); ++i) {
    if (!moved.empty()) {
      const Eigen::Isometry3d step = images.T_world_camera(moved.back()).inverse() * images.T_world_camera(i);
      const double turn_deg = rotation_angle_rad(step.linear()) * (180.0 / std::numbers::pi);
      if (step.translation().norm() < options.step_m && turn_deg < options.step_deg) continue;
    }
    moved.push_back(i);
  }
  const auto most = static_cast<std::size_t>(options.most_images);
  if (moved.size() <= most) return moved;
  const std::size_t length = std::min(most, static_cast<std::size_t>(options.run_length));
  const std::size_t n_runs = most / length;
  std::vector<std::size_t> chosen;
  for (std::size_t run = 0; run < n_runs; ++run) {
    const std::size_t first = n_runs == 1 ? (moved.size() - length) / 2 : run * (moved.size() - length) / (n_runs - 1);
    for (std::size_t i = first; i < first + length; ++i) {
      if (chosen.empty() || moved[i] > chosen.back()) chosen.push_back(moved[i]);
    }
  }
  return chosen;
}

ViewTracks make_tracks(const Surfels& surfels, const PosedImages& images, std::vector<KeptImage>& kept,
                       const Eigen::Isometry3d& T_lidar_camera, const ColorizeOptions& options,
                       const RefineOptions& refine) {
  const auto most = static_cast<std::size_t>(refine.most_points);
  const std::size_t step = std::max<std::size_t>(1, surfels.size() / (most * kCandidatesPerPoint));
  Observations observations(surfels.size() / step + 1, 16);
  std::vector<Sighting> sightings;
  DepthBuffer buffer(images.camera, options.occlusion);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    throw_if_stopped();
    const Eigen::Isometry3d T_world_lidar = images.list[kept[k].place].T_world_lidar;
    const Array<ViewPoint> points =
        points_in_view(surfels, images.camera, (T_world_lidar * T_lidar_camera).inverse(), options.occlusion);
    buffer.fill(points);
    for (const ViewPoint& point : points) {
      if (point.slot % step != 0 || !point.is_inside || buffer.hides(point)) continue;
      const auto sample = kept[k].gray.at(0, point.pixel.cast<double>());
      if (!sample) continue;
      const auto weight = static_cast<float>(view_weight(point, images.camera, options.weight));
      const auto gray = static_cast<std::uint8_t>(std::lround(sample->level));
      const auto candidate = static_cast<std::uint32_t>(point.slot / step);
      observations.add(candidate, {weight, static_cast<std::uint32_t>(k), {gray, gray, gray}});
      const Eigen::Vector3d p = T_lidar_camera * point.position.cast<double>();
      sightings.push_back({candidate, {p, static_cast<std::uint32_t>(k), weight}});
    }
  }
  const Eigen::Matrix3Xd gains = exposure_gains_of(observations, kept.size(), options.exposure);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    kept[k].gain = static_cast<float>(gains(0, static_cast<Eigen::Index>(k)));
  }
  std::ranges::stable_sort(sightings, {}, &Sighting::candidate);

  std::size_t n_usable = 0;
  const auto least = static_cast<std::size_t>(refine.least_views);
  const auto for_each_point = [&](auto&& use) {
    for (std::size_t begin = 0, end = 0; begin < sightings.size(); begin = end) {
      while (end < sightings.size() && sightings[end].candidate == sightings[begin].candidate) ++end;
      if (end - begin >= least) use(begin, end);
    }
  };
  for_each_point([&](std::size_t, std::size_t) { ++n_usable; });
  ViewTracks tracks;
  std::size_t point = 0;
  for_each_point([&](std::size_t begin, std::size_t end) {
    if ((point + 1) * most / std::max(n_usable, most) > point * most / std::max(n_usable, most)) {
      for (std::size_t i = begin; i < end; ++i) tracks.views.push_back(sightings[i].view);
      tracks.starts.push_back(tracks.views.size());
    }
    ++point;
  });
  return tracks;
}

}  // namespace cmap
