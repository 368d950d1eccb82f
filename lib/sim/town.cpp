#include <fmt/format.h>

#include <cmath>

#include "cmap/core/error.hpp"
#include "sim/noise.hpp"
#include "sim/option_check.hpp"
#include "sim/scene_builder.hpp"
#include "sim/scene_routes.hpp"
#include "sim/town_ground.hpp"

namespace cmap {
namespace {

void check(const TownOptions& options) {
  require_at_least("blocks_x", options.blocks_x, 3);
  require_at_least("blocks_y", options.blocks_y, 3);
  require_at_least("block_x_m", options.block_x_m, 30.0);
  require_at_least("block_y_m", options.block_y_m, 30.0);
  require_at_least("street_width_m", options.street_width_m, 8.0);
  require_at_least("undulation_m", options.undulation_m, 0.0);
  require_at_least("trees_per_100m", options.trees_per_100m, 0.0);
  require_at_least("cars_per_100m", options.cars_per_100m, 0.0);
}

void add_routes(SceneMesh& mesh, const TownLayout& layout) {
  const auto height = [layout](double x, double y) {
    return static_cast<double>(layout.road_height(static_cast<float>(x), static_cast<float>(y)));
  };
  const auto middle_x = static_cast<std::size_t>((layout.streets_x.size() - 1) / 2);
  const auto middle_y = static_cast<std::size_t>((layout.streets_y.size() - 1) / 2);
  const double west = layout.streets_x[middle_x], east = layout.streets_x[middle_x + 1];
  const double south = layout.streets_y[middle_y], north = layout.streets_y[middle_y + 1];
  const double reach = layout.half_x - TownLayout::kMargin_m;
  mesh.routes.push_back(rounded_route("street", {{-reach, south}, {reach, south}}, false, 5.0, height));
  mesh.routes.push_back(
      rounded_route("block_loop", {{west, south}, {east, south}, {east, north}, {west, north}}, true, 5.0, height));
  mesh.ground_height_m = height;
}

}  // namespace

Scene make_town(const TownOptions& options) {
  check(options);
  const TownLayout layout(options);
  SceneBuilder builder;
  add_town_ground(builder, layout, static_cast<std::uint32_t>(options.seed));
  for (int i = 0; i < options.blocks_x; ++i) {
    for (int j = 0; j < options.blocks_y; ++j) {
      const Eigen::Vector2f c = layout.block_corner(i, j);
      Surface wall;
      wall.base = {0.7F, 0.6F, 0.5F};
      builder.box(wall, {c.x() + 2.0F, c.y() + 2.0F, -2.0F}, {c.x() + layout.block_x - 2.0F, c.y() + layout.block_y - 2.0F, 9.0F});
    }
  }
  add_routes(builder.mesh, layout);
  return builder.finish();
}

}  // namespace cmap
