#pragma once

#include <nlohmann/json.hpp>

#include "cmap/render/camera.hpp"

namespace cmap {

/// Whether a JSON object is a camera as Open3D saves it: the view that its viewer copies, or pinhole parameters.
bool is_open3d_camera(const nlohmann::ordered_json& json);

/// Throws UsageError naming what is missing, wrong, or of no use to a picture: several views, a principal point that is
/// not in the middle, pixels that are not square.
Camera camera_from_open3d(const nlohmann::ordered_json& json);

}  // namespace cmap
