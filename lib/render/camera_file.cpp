#include <fmt/format.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "camera_json.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/io/json_text.hpp"
#include "cmap/render/camera.hpp"
#include "open3d_camera.hpp"

namespace cmap {

using Json = nlohmann::ordered_json;

namespace {

[[noreturn]] void refuse_key(const std::string& key) {
  const std::vector<std::string> known{"position_m", "target_m", "up", "field_of_view_deg", "view_height_m"};
  throw UsageError(fmt::format(
      "unknown key \"{}\"{}; a camera has position_m, target_m, up and field_of_view_deg or view_height_m, or is one "
      "that Open3D saved",
      key, did_you_mean(key, known)));
}

Camera camera_from_ours(const Json& json) {
  Camera camera;
  bool has_field_of_view = false;
  for (const auto& [key, value] : json.items()) {
    if (key == "position_m") {
      camera.position = camera_numbers(key, value, 3);
    } else if (key == "target_m") {
      camera.target = camera_numbers(key, value, 3);
    } else if (key == "up") {
      camera.up = camera_numbers(key, value, 3);
    } else if (key == "field_of_view_deg") {
      camera.field_of_view_deg = camera_number(key, value, 0.0, 180.0);
      has_field_of_view = true;
    } else if (key == "view_height_m") {
      camera.view_height_m = camera_number(key, value, 0.0, kMaxCoordinate_m);
      camera.orthographic = true;
    } else {
      refuse_key(key);
    }
  }
  for (const char* key : {"position_m", "target_m"}) (void)camera_member(json, key);
  if (has_field_of_view && camera.orthographic)
    throw UsageError("field_of_view_deg and view_height_m exclude each other");
  return camera;
}

Camera camera_from(const Json& json) {
  if (!json.is_object()) throw UsageError("expected a JSON object");
  const Camera camera = is_open3d_camera(json) ? camera_from_open3d(json) : camera_from_ours(json);
  const Eigen::Vector3d forward = camera.target - camera.position;
  if (!(forward.norm() > 0.0)) throw UsageError("the camera looks nowhere: position and target are the same");
  constexpr double kParallel = 1e-6;
  if (!(forward.normalized().cross(camera.up.normalized()).norm() > kParallel)) {
    throw UsageError("up is along the view");
  }
  return camera;
}

}  // namespace

Camera read_camera(const std::filesystem::path& path) {
  Camera camera;
  read_json_file(path, "a camera", [&](const Json& json) { camera = camera_from(json); });
  return camera;
}

}  // namespace cmap
