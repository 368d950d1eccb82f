#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cmap/colorize/colorize_report.hpp"
#include "cmap/io/transform_file.hpp"

namespace cmap {
namespace {

nlohmann::ordered_json numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

std::string refined_table(const RefinedExtrinsic& r) {
  const Eigen::Vector3d shift_cm = 100.0 * r.shift_m, sigma_cm = 100.0 * r.shift_sigma_m;
  std::string text = fmt::format("extrinsic      would change by {:.3f} deg and {:.2f} cm; not applied\n",
                                 r.turn_deg.norm(), shift_cm.norm());
  text += fmt::format("  turn x y z   {:+.3f} {:+.3f} {:+.3f} deg   +- {:.3f} {:.3f} {:.3f}\n", r.turn_deg.x(),
                      r.turn_deg.y(), r.turn_deg.z(), r.turn_sigma_deg.x(), r.turn_sigma_deg.y(), r.turn_sigma_deg.z());
  text += fmt::format("  shift x y z  {:+.2f} {:+.2f} {:+.2f} cm   +- {:.2f} {:.2f} {:.2f}\n", shift_cm.x(),
                      shift_cm.y(), shift_cm.z(), sigma_cm.x(), sigma_cm.y(), sigma_cm.z());
  text +=
      fmt::format("  gray levels  {:.5f} apart in place of {:.5f}, {:.1f} % less; {} views of {} points in {} images\n",
                  r.inconsistency_after, r.inconsistency_before,
                  100.0 * (1.0 - r.inconsistency_after / r.inconsistency_before), r.n_views, r.n_points, r.n_images);
  if (!r.free_axes.empty()) {
    text += fmt::format("  not told by these images, left as they were: {} of 6 directions, mostly {}\n",
                        r.free_axes.size(), fmt::join(r.free_axes, ", "));
  }
  return text;
}

nlohmann::ordered_json refined_json(const RefinedExtrinsic& r) {
  return {{"T_lidar_camera", transform_json(r.T_lidar_camera.matrix())},
          {"improved", r.improved},
          {"turn_deg", numbers(r.turn_deg)},
          {"shift_m", numbers(r.shift_m)},
          {"turn_sigma_deg", numbers(r.turn_sigma_deg)},
          {"shift_sigma_m", numbers(r.shift_sigma_m)},
          {"free_axes", r.free_axes},
          {"inconsistency", {{"before", r.inconsistency_before}, {"after", r.inconsistency_after}}},
          {"images", r.n_images},
          {"points", r.n_points},
          {"views", r.n_views}};
}

}  // namespace cmap
