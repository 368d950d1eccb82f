#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/option_check.hpp"
#include "scene/facade.hpp"
#include "scene/scene_objects.hpp"
#include "scene/scene_routes.hpp"
#include "scene/town_ground.hpp"
#include "sensors/noise.hpp"

namespace cmap {
namespace {

constexpr float kHouseDepth_m = 10.5F;
/// From the sidewalk to the houses.
constexpr float kFrontYard_m = 1.6F;
constexpr float kQuarterTurn = 0.5F * std::numbers::pi_v<float>;

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

/// Places objects on a town's ground.
class TownBuilder {
 public:
  explicit TownBuilder(const TownOptions& options) : options_(options), layout_(options), random_(options.seed) {
    add_town_ground(builder_, layout_, random_.bits());
  }

  void add_blocks() {
    for (int j = 0; j < options_.blocks_y; ++j) {
      for (int i = 0; i < options_.blocks_x; ++i) add_block(layout_.block_corner(i, j));
    }
  }

  void add_streets() {
    for (const float y : layout_.streets_y) add_street_sides({-end_x(), y}, 0.0F, 2.0F * end_x(), layout_.streets_x);
    for (const float x : layout_.streets_x) {
      add_street_sides({x, -end_y()}, kQuarterTurn, 2.0F * end_y(), layout_.streets_y);
    }
  }

  /// Woods around the town close the views along its streets.
  void add_outskirts() {
    const float ring_x = layout_.half_x - 9.0F, ring_y = layout_.half_y - 9.0F;
    const auto tree_at = [&](float x, float y) {
      place({x + random_.between(-4.5F, 4.5F), y + random_.between(-4.5F, 4.5F)}, random_.between(0.0F, 6.0F));
      if (random_.chance(0.45F)) {
        add_fir(builder_, random_, random_.between(8.0F, 14.0F), 900);
      } else {
        add_tree(builder_, random_, random_.between(8.0F, 13.0F), 0.5F, 1000);
      }
    };
    constexpr float kSpacing_m = 5.5F;
    for (float x = -ring_x; x <= ring_x; x += kSpacing_m) {
      tree_at(x, -ring_y);
      tree_at(x, ring_y);
    }
    for (float y = -ring_y; y <= ring_y; y += kSpacing_m) {
      tree_at(-ring_x, y);
      tree_at(ring_x, y);
    }
  }

  Scene finish() {
    add_routes();
    return builder_.finish();
  }

 private:
  float end_x() const { return layout_.half_x - TownLayout::kMargin_m; }
  float end_y() const { return layout_.half_y - TownLayout::kMargin_m; }

  /// Moves the builder's frame to the ground (curb height) at `at`.
  void place(const Eigen::Vector2f& at, float heading_rad, float above = TownLayout::kCurb_m) {
    builder_.frame = placed_at({at.x(), at.y(), layout_.road_height(at.x(), at.y()) + above}, heading_rad);
  }

  /// A row of houses from `start` on, fronts to the right-hand side of `heading`.
  void add_row(const Eigen::Vector2f& start, float heading_rad, float length) {
    const Eigen::Vector2f along(std::cos(heading_rad), std::sin(heading_rad));
    float at = 0.0F;
    while (length - at >= 8.0F) {
      float width = random_.between(9.5F, 15.0F);
      if (length - at - width < 8.0F) width = length - at;
      if (width > 17.0F) width *= 0.5F;
      const HouseStyle style = random_house_style(random_, 2 + random_.below(3));
      place(start + (at + 0.5F * width) * along, heading_rad, TownLayout::kCurb_m + 0.25F);
      builder_.frame.translation() -= (0.5F * width) * Eigen::Vector3f(along.x(), along.y(), 0.0F);
      add_house(builder_, random_, style, width, kHouseDepth_m);
      at += width;
      if (random_.chance(0.35F)) at += random_.between(2.0F, 4.0F);
    }
  }

  /// Houses along all four sides, a yard with trees inside.
  void add_block(const Eigen::Vector2f& corner) {
    const float w = layout_.block_x, h = layout_.block_y, f = kFrontYard_m, d = f + kHouseDepth_m;
    add_row(corner + Eigen::Vector2f(f, f), 0.0F, w - 2.0F * f);
    add_row(corner + Eigen::Vector2f(w - f, h - f), 2.0F * kQuarterTurn, w - 2.0F * f);
    constexpr float kGap_m = 2.5F;
    add_row(corner + Eigen::Vector2f(w - f, d + kGap_m), kQuarterTurn, h - 2.0F * (d + kGap_m));
    add_row(corner + Eigen::Vector2f(f, h - d - kGap_m), -kQuarterTurn, h - 2.0F * (d + kGap_m));
    const float inner = d + 4.0F;
    for (int i = 0; i < 5; ++i) {
      place(corner + Eigen::Vector2f(random_.between(inner, w - inner), random_.between(inner, h - inner)),
            random_.between(0.0F, 6.0F));
      add_tree(builder_, random_, random_.between(5.0F, 10.0F), 0.4F, 1100);
    }
  }

  /// Whether a place along a street is far enough from the streets that cross it.
  bool is_between_crossings(float along, const std::vector<float>& crossings, float clearance) const {
    return std::none_of(crossings.begin(), crossings.end(),
                        [&](float c) { return std::abs(along - c) < 0.5F * layout_.street + clearance; });
  }

  /// Trees, lamps, cars, benches and so on along both sides of a street that starts at `start`.
  void add_street_sides(const Eigen::Vector2f& start, float heading_rad, float length,
                        const std::vector<float>& crossings) {
    const Eigen::Vector2f along(std::cos(heading_rad), std::sin(heading_rad)), left(-along.y(), along.x());
    const float first = start.dot(along);
    for (const float side : {1.0F, -1.0F}) {
      const auto row = [&](float per_100m, float clearance, float offset, auto&& add) {
        if (per_100m <= 0.0F) return;
        const float spacing = 100.0F / per_100m;
        for (float at = spacing * random_.between(0.2F, 0.8F); at < length;
             at += spacing * random_.between(0.75F, 1.25F)) {
          if (!is_between_crossings(first + at, crossings, clearance)) continue;
          add(Eigen::Vector2f(start + at * along + side * offset * left));
        }
      };
      const float curb = layout_.road_half_width();
      const float facing_street = heading_rad + (side > 0.0F ? 0.0F : 2.0F * kQuarterTurn);
      row(static_cast<float>(options_.trees_per_100m), 3.0F, curb + 0.7F, [&](const Eigen::Vector2f& at) {
        place(at, random_.between(0.0F, 6.0F));
        add_tree(builder_, random_, random_.between(5.5F, 8.5F), 0.26F, 2600);
      });
      row(static_cast<float>(options_.cars_per_100m), 6.5F, curb - 1.1F, [&](const Eigen::Vector2f& at) {
        place(at, heading_rad + (side > 0.0F ? 2.0F * kQuarterTurn : 0.0F) + random_.between(-0.03F, 0.03F), 0.0F);
        add_car(builder_, random_);
      });
      row(3.2F, 1.5F, curb + 0.35F, [&](const Eigen::Vector2f& at) {
        place(at, facing_street - kQuarterTurn);
        add_street_lamp(builder_);
      });
      row(2.5F, 2.0F, curb + 1.6F, [&](const Eigen::Vector2f& at) {
        place(at, facing_street);
        add_bench(builder_, random_);
      });
      row(2.5F, 2.0F, curb + 0.4F, [&](const Eigen::Vector2f& at) {
        place(at, 0.0F);
        add_trash_bin(builder_, random_);
      });
      row(2.0F, 1.0F, curb + 0.4F, [&](const Eigen::Vector2f& at) {
        place(at, facing_street + (random_.chance(0.5F) ? kQuarterTurn : -kQuarterTurn));
        add_sign(builder_, random_);
      });
      row(3.0F, 2.0F, curb + TownLayout::kSidewalk_m + 0.7F, [&](const Eigen::Vector2f& at) {
        place(at, heading_rad);
        add_hedge(builder_, random_, random_.between(3.0F, 6.0F), 1.0F);
      });
    }
  }

  void add_routes() {
    const auto height = [layout = layout_](double x, double y) {
      return static_cast<double>(layout.road_height(static_cast<float>(x), static_cast<float>(y)));
    };
    const std::size_t i = (layout_.streets_x.size() - 1) / 2, j = (layout_.streets_y.size() - 1) / 2;
    const double west = layout_.streets_x[i], east = layout_.streets_x[i + 1];
    const double south = layout_.streets_y[j], north = layout_.streets_y[j + 1];
    builder_.mesh.ground_height_m = height;
    builder_.mesh.routes = {
        rounded_route("street", {{-end_x(), south}, {end_x(), south}}, false, 5.0, height),
        rounded_route("block_loop", {{west, south}, {east, south}, {east, north}, {west, north}}, true, 5.0, height)};
  }

  const TownOptions& options_;
  TownLayout layout_;
  SceneRandom random_;
  SceneBuilder builder_;
};

}  // namespace

Scene make_town(const TownOptions& options) {
  check(options);
  TownBuilder town(options);
  town.add_blocks();
  town.add_streets();
  town.add_outskirts();
  return town.finish();
}

}  // namespace cmap
