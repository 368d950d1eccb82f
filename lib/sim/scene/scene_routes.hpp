#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cmap/sim/scene.hpp"

namespace cmap {

/// The route along `corners` (x and y), each rounded by an arc of at most `radius_m`; z from `height_m(x, y)`.
SceneRoute rounded_route(std::string name, const std::vector<Eigen::Vector2d>& corners, bool closed, double radius_m,
                         const std::function<double(double, double)>& height_m);

}  // namespace cmap
