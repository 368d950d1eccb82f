#include <algorithm>
#include <numbers>

#include "capture/option_check.hpp"
#include "scene/facade.hpp"
#include "scene/indoor_room.hpp"
#include "scene/scene_objects.hpp"
#include "scene/scene_routes.hpp"

namespace cmap {
namespace {

constexpr float kHalfTurn = std::numbers::pi_v<float>;

void check(const IndoorOptions& options) {
  require_at_least("length_m", options.length_m, 18.0);
  require_at_least("width_m", options.width_m, 18.0);
  require_between("corridor_width_m", options.corridor_width_m, 1.5, 3.0);
  require_at_least("ceiling_m", options.ceiling_m, 2.4);
  require_between("furniture", options.furniture, 0.0, 1.0);
}

/// From outside in: rooms, the corridor's ring, the rooms of the core.
class FloorBuilder {
 public:
  explicit FloorBuilder(const IndoorOptions& options)
      : half_x_(0.5F * static_cast<float>(options.length_m)),
        half_y_(0.5F * static_cast<float>(options.width_m)),
        corridor_(static_cast<float>(options.corridor_width_m)),
        height_(static_cast<float>(options.ceiling_m)),
        furniture_(static_cast<float>(options.furniture)),
        depth_(std::clamp(0.4F * std::min(half_x_, half_y_), 3.6F, 5.5F)),
        random_(options.seed) {
    builder_.mesh.lighting = Lighting::kRoom;
  }

  void add_rooms() {
    const float ring_x = half_x_ - depth_, ring_y = half_y_ - depth_;
    // The rows along x take the corners; only what lies on the corridor can have a door.
    add_row({half_x_, -ring_y}, kHalfTurn, 2.0F * half_x_, depth_, depth_, true);
    add_row({-half_x_, ring_y}, 0.0F, 2.0F * half_x_, depth_, depth_, true);
    add_row({ring_x, ring_y}, -0.5F * kHalfTurn, 2.0F * ring_y, depth_, 0.0F, true);
    add_row({-ring_x, -ring_y}, 0.5F * kHalfTurn, 2.0F * ring_y, depth_, 0.0F, true);
    const float core_x = ring_x - corridor_, core_y = ring_y - corridor_;
    if (core_y >= 2.6F) {
      add_row({-core_x, -core_y}, 0.0F, 2.0F * core_x, core_y, 0.0F, false);
      add_row({core_x, core_y}, kHalfTurn, 2.0F * core_x, core_y, 0.0F, false);
    } else {
      add_core_wall({-core_x, -core_y, 0}, {1, 0, 0}, 2.0F * core_x);
      add_core_wall({core_x, core_y, 0}, {-1, 0, 0}, 2.0F * core_x);
    }
    add_core_wall({core_x, -core_y, 0}, {0, 1, 0}, 2.0F * core_y);
    add_core_wall({-core_x, core_y, 0}, {0, -1, 0}, 2.0F * core_y);
  }

  void add_corridor() {
    const float ring_x = half_x_ - depth_, ring_y = half_y_ - depth_;
    const float core_x = ring_x - corridor_, core_y = ring_y - corridor_;
    add_floor_and_ceiling(-ring_x, ring_x, -ring_y, -core_y);
    add_floor_and_ceiling(-ring_x, ring_x, core_y, ring_y);
    add_floor_and_ceiling(-ring_x, -core_x, -core_y, core_y);
    add_floor_and_ceiling(core_x, ring_x, -core_y, core_y);
    const float in = 0.45F;
    for (const float x : {-ring_x + in, ring_x - in}) {
      for (const float y : {-ring_y + in, ring_y - in}) add_pot_plant(builder_, random_, {x, y, 0.0F});
    }
    for (int i = 0; i < 3 && furniture_ > 0.0F; ++i) {  // along the core, out of the way
      builder_.frame = placed_at({random_.between(-0.8F, 0.8F) * core_x, core_y + 0.42F, 0.0F}, kHalfTurn);
      add_bench(builder_, random_);
      builder_.frame = placed_at({random_.between(-0.8F, 0.8F) * core_x, -core_y - 0.30F, 0.0F}, 0.0F);
      add_trash_bin(builder_, random_);
    }
    builder_.frame = Eigen::Isometry3f::Identity();
  }

  Scene finish() {
    const double x = half_x_ - depth_ - 0.5F * corridor_, y = half_y_ - depth_ - 0.5F * corridor_;
    builder_.mesh.ground_height_m = [](double, double) { return 0.0; };
    builder_.mesh.routes = {rounded_route("corridor_loop", {{-x, -y}, {x, -y}, {x, y}, {-x, y}}, true,
                                          0.9 * static_cast<double>(corridor_), builder_.mesh.ground_height_m)};
    return builder_.finish();
  }

 private:
  /// Rooms side by side along a corridor, from `start` on, on the left-hand side of `heading`. Nothing within `corner`
  /// of the row's ends is on the corridor.
  void add_row(const Eigen::Vector2f& start, float heading_rad, float length, float depth, float corner,
               bool has_windows) {
    const int n = std::max(1, static_cast<int>((length - 2.0F * corner) / 4.6F));
    float at = 0.0F;
    for (int i = 0; i < n; ++i) {
      const float share = (length - 2.0F * corner) / static_cast<float>(n);
      const float wobble = i + 1 < n ? random_.between(-0.5F, 0.5F) : 0.0F;
      const float end = i + 1 < n ? corner + static_cast<float>(i + 1) * share + wobble : length;
      const float width = end - at;
      builder_.frame = placed_at({start.x(), start.y(), 0.0F}, heading_rad);
      builder_.frame.translation() = builder_.frame * Eigen::Vector3f(at, 0.0F, 0.0F);
      const float from = std::max(0.35F, corner - at + 0.35F);
      const float to = std::min(width - 0.35F, length - corner - at - 0.35F);
      add_room(builder_, random_, {width, depth, height_, from, to, has_windows}, furniture_);
      at = end;
    }
    builder_.frame = Eigen::Isometry3f::Identity();
  }

  void add_core_wall(const Eigen::Vector3f& start, const Eigen::Vector3f& along, float length) {
    Surface paint;
    paint.material = Material::kBrick;
    paint.base = {0.66F, 0.42F, 0.34F};
    paint.accent = {0.70F, 0.68F, 0.64F};
    paint.seed = random_.bits();
    add_panel(builder_, {start, along}, {0.0F, length, 0.0F, height_}, 0.0F, paint);
    hang_pictures(builder_, random_, start, along, 0.4F, length - 0.4F);
  }

  void add_floor_and_ceiling(float x0, float x1, float y0, float y1) {
    Surface floor;
    floor.material = Material::kFloorTiles;
    floor.base = {0.70F, 0.68F, 0.64F};
    floor.accent = {0.45F, 0.43F, 0.42F};
    floor.seed = 301;
    builder_.quad(builder_.add(floor), {x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0});
    Surface ceiling;
    ceiling.material = Material::kCeiling;
    ceiling.base = {0.88F, 0.88F, 0.86F};
    ceiling.seed = 302;
    builder_.quad(builder_.add(ceiling), {x0, y0, height_}, {x0, y1, height_}, {x1, y1, height_}, {x1, y0, height_});
  }

  float half_x_, half_y_, corridor_, height_, furniture_, depth_;
  SceneRandom random_;
  SceneBuilder builder_;
};

}  // namespace

Scene make_indoor(const IndoorOptions& options) {
  check(options);
  FloorBuilder floor(options);
  floor.add_rooms();
  floor.add_corridor();
  return floor.finish();
}

}  // namespace cmap
