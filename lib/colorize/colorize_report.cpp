#include "cmap/colorize/colorize_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cmap/core/version.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/io/options_json.hpp"
#include "cmap/io/transform_file.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// Of the points that were seen.
struct Views {
  std::uint32_t least = 0, median = 0, most = 0;
};

Views views_of(const Colorization& result) {
  std::vector<std::uint32_t> seen;
  for (const std::uint32_t n : result.views) {
    if (n > 0) seen.push_back(n);
  }
  if (seen.empty()) return {};
  const auto [least, most] = std::ranges::minmax(seen);
  return {least, upper_median(seen), most};
}

std::array<double, 2> gain_range(const Colorization& result) {
  std::array<double, 2> range{1.0, 1.0};
  for (const ColoredFrom& image : result.images) {
    for (const double gain : image.gain) range = {std::min(range[0], gain), std::max(range[1], gain)};
  }
  return range;
}

double unseen_share(const Colorization& result) {
  const auto n = static_cast<double>(result.views.size());
  return (n - static_cast<double>(result.n_seen)) / n;
}

Json map_json(const Colorization& result, const ColorizeInput& input) {
  const Views views = views_of(result);
  Json map{{"points", result.views.size()},
           {"voxel_m", input.voxel_m > 0.0 ? Json(input.voxel_m) : Json()},
           {"surfel_m", result.surfel_m},
           {"seen", result.n_seen},
           {"unseen_share", unseen_share(result)},
           {"views", {{"least", views.least}, {"median", views.median}, {"most", views.most}}},
           {"inconsistency", std::isnan(result.inconsistency) ? Json() : Json(result.inconsistency)}};
  if (input.scans) {
    map["scans"] = {
        {"scans", input.scans->n_scans}, {"points", input.scans->n_points}, {"placed", input.scans->n_placed}};
  }
  return map;
}

}  // namespace

std::string colorize_table(const Colorization& result, const ColorizeInput& input) {
  const Views views = views_of(result);
  const auto [low, high] = gain_range(result);
  std::string text = fmt::format("map            {} points", result.views.size());
  if (input.scans) text += fmt::format(" of {} in {} scans", input.scans->n_points, input.scans->n_scans);
  if (input.voxel_m > 0.0) text += fmt::format(", voxel {:g} m", input.voxel_m);
  text += fmt::format("\nimages         {} of {}", result.images.size(), input.n_chosen);
  if (input.n_without_pose > 0) text += fmt::format(", {} without a pose", input.n_without_pose);
  text += fmt::format("\nseen           {} points, {:.1f} % unseen\n", result.n_seen, 100.0 * unseen_share(result));
  text += fmt::format("views          {} a seen point (median; {} to {})\n", views.median, views.least, views.most);
  text += fmt::format("gains          {:.3f} to {:.3f}\n", low, high);
  text += fmt::format("inconsistency  {:.4f} unit RGB, of a point's views\n", result.inconsistency);
  return text;
}

Json colorize_json(const Colorization& result, const ColorizeInput& input, const ColorizeOptions& options,
                   const std::string& command) {
  Json images = Json::array();
  for (const ColoredFrom& image : result.images) {
    images.push_back(
        {{"index", image.index}, {"timestamp_s", image.time_s}, {"seen", image.n_seen}, {"gain", image.gain}});
  }
  ColorizeOptions described = options;
  return {{"schema", "cmap.colorize/1"},
          {"tool", {{"name", "cmap"}, {"version", kVersion}}},
          {"options", options_json(fields_of(described))},
          {"T_lidar_camera", transform_json(input.T_lidar_camera.matrix())},
          {"map", map_json(result, input)},
          {"images", {{"chosen", input.n_chosen}, {"without_pose", input.n_without_pose}, {"used", images}}},
          {"run", {{"command", command}}}};
}

}  // namespace cmap
