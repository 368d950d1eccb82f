#include <fmt/format.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "cmap/core/error.hpp"
#include "cmap/io/json_text.hpp"
#include "cmap/render/camera.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

double number(const std::string& key, const Json& value, double above, double below) {
  if (!value.is_number()) throw UsageError(fmt::format("{}: {} is not a number", key, value.dump()));
  const double v = value.get<double>();
  if (!(v > above && v < below))
    throw UsageError(fmt::format("{}: {} must lie between {} and {}", key, v, above, below));
  return v;
}

Eigen::Vector3d vector(const std::string& key, const Json& value) {
  if (!value.is_array() || value.size() != 3) throw UsageError(fmt::format("{}: expected [x, y, z]", key));
  Eigen::Vector3d v;
  for (int axis = 0; axis < 3; ++axis) {
    v[axis] = number(key, value[static_cast<std::size_t>(axis)], -kMaxCoordinate_m, kMaxCoordinate_m);
  }
  return v;
}

Camera camera_from(const Json& json) {
  if (!json.is_object()) throw UsageError("expected a JSON object");
  Camera camera;
  bool has_field_of_view = false;
  for (const auto& [key, value] : json.items()) {
    if (key == "position_m") {
      camera.position = vector(key, value);
    } else if (key == "target_m") {
      camera.target = vector(key, value);
    } else if (key == "up") {
      camera.up = vector(key, value);
    } else if (key == "field_of_view_deg") {
      camera.field_of_view_deg = number(key, value, 0.0, 180.0);
      has_field_of_view = true;
    } else if (key == "view_height_m") {
      camera.view_height_m = number(key, value, 0.0, kMaxCoordinate_m);
      camera.orthographic = true;
    } else {
      throw UsageError(fmt::format("unknown key \"{}\"", key));
    }
  }
  for (const char* key : {"position_m", "target_m"}) {
    if (!json.contains(key)) throw UsageError(fmt::format("{} is missing", key));
  }
  if (has_field_of_view && camera.orthographic)
    throw UsageError("field_of_view_deg and view_height_m exclude each other");
  const Eigen::Vector3d forward = camera.target - camera.position;
  if (!(forward.norm() > 0.0)) throw UsageError("position_m and target_m are the same");
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
