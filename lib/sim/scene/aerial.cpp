#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/option_check.hpp"
#include "scene/aerial_land.hpp"
#include "scene/facade.hpp"
#include "scene/scene_objects.hpp"
#include "scene/scene_routes.hpp"

namespace cmap {
namespace {

void check(const AerialOptions& options) {
  require_at_least("length_m", options.length_m, 150.0);
  require_at_least("width_m", options.width_m, 150.0);
  require_at_least("relief_m", options.relief_m, 0.0);
  require_at_least("buildings", options.buildings, 0);
  require_at_least("trees", options.trees, 0);
  require_at_least("survey_altitude_m", options.survey_altitude_m, 20.0);
  require_at_least("survey_spacing_m", options.survey_spacing_m, 5.0);
}

class StripBuilder {
 public:
  explicit StripBuilder(const AerialOptions& options)
      : options_(options), random_(options.seed), land_(options, random_) {
    add_land(builder_, random_, land_);
  }

  /// Along the road, gables or eaves to it; every fourth is a farm somewhere in a meadow.
  void add_buildings() {
    for (int i = 0; i < options_.buildings; ++i) {
      for (int attempt = 0; attempt < 60; ++attempt) {
        const bool is_farm = i % 4 == 3;
        const float side = random_.chance(0.5F) ? 1.0F : -1.0F;
        const float x = random_.between(-0.94F, 0.94F) * land_.half_x;
        const float y = is_farm ? random_.between(-0.85F, 0.85F) * land_.half_y
                                : land_.road_y + side * random_.between(14.0F, 32.0F);
        if (!is_free({x, y}, is_farm ? 14.0F : 11.0F)) continue;
        sites_.push_back({x, y});
        add_building({x, y}, is_farm, side);
        break;
      }
    }
  }

  /// In woods, along the river, around houses, and alone in meadows and at the edges of fields.
  void add_trees() {
    for (int i = 0; i < options_.trees; ++i) {
      for (int attempt = 0; attempt < 40; ++attempt) {
        const Eigen::Vector2f at = tree_place(i % 4);
        if (std::abs(at.x()) > 0.97F * land_.half_x || std::abs(at.y()) > 0.97F * land_.half_y) continue;
        if (!land_.is_dry(at.x(), at.y(), i % 4 == 1 ? -5.0F : 2.0F) || !is_clear_of_houses(at, 9.5F)) continue;
        place(at, random_.between(0.0F, 6.0F), 0.0F);
        if (random_.chance(0.25F)) {
          add_fir(builder_, random_, random_.between(9.0F, 17.0F), 450);
        } else {
          add_tree(builder_, random_, random_.between(7.0F, 14.0F), 0.8F, 490);
        }
        break;
      }
    }
  }

  void add_cars() {
    for (float x = -0.95F * land_.half_x; x < 0.95F * land_.half_x; x += random_.between(25.0F, 80.0F)) {
      const bool is_eastbound = random_.chance(0.5F);
      place({x, land_.road_y + (is_eastbound ? -1.7F : 1.7F)}, is_eastbound ? 0.0F : std::numbers::pi_v<float>, 0.08F);
      add_car(builder_, random_);
    }
  }

  Scene finish() {
    builder_.mesh.ground_height_m = [land = land_](double x, double y) {
      const float fx = static_cast<float>(x), fy = static_cast<float>(y);
      const bool on_road = std::abs(fy - land.road_y) < Land::kRoadHalf_m;
      return static_cast<double>(std::max(land.height(fx, fy) + (on_road ? 0.08F : 0.0F), land.water_z));
    };
    add_survey();
    return builder_.finish();
  }

 private:
  void place(const Eigen::Vector2f& at, float heading_rad, float above) {
    builder_.frame = placed_at({at.x(), at.y(), land_.height(at.x(), at.y()) + above}, heading_rad);
  }

  bool is_clear_of_houses(const Eigen::Vector2f& at, float distance) const {
    return std::none_of(sites_.begin(), sites_.end(),
                        [&](const Eigen::Vector2f& site) { return (site - at).norm() < distance; });
  }

  bool is_free(const Eigen::Vector2f& at, float reach) const {
    return land_.is_dry(at.x(), at.y(), reach - 1.0F) && is_clear_of_houses(at, 2.0F * reach) &&
           !on_field_edge(at, reach) && use_at(at) == LandUse::kMeadow;
  }

  const FarmField* field_at(const Eigen::Vector2f& at) const {
    for (const FarmField& f : land_.fields) {
      if (at.x() >= f.x0 && at.x() < f.x1 && at.y() >= f.y0 && at.y() < f.y1) return &f;
    }
    return nullptr;
  }
  LandUse use_at(const Eigen::Vector2f& at) const {
    const FarmField* field = field_at(at);
    return field == nullptr ? LandUse::kCrop : field->use;
  }
  /// Tracks run along the edges.
  bool on_field_edge(const Eigen::Vector2f& at, float reach) const {
    const FarmField* field = field_at(at);
    return field == nullptr || at.x() - field->x0 < reach || field->x1 - at.x() < reach;
  }

  void add_building(const Eigen::Vector2f& at, bool is_farm, float side) {
    HouseStyle style = random_house_style(random_, is_farm ? 2 : 1 + random_.below(2));
    style.has_shop = style.has_balconies = false;
    style.has_flat_roof = style.has_flat_roof && !is_farm && random_.chance(0.5F);
    const float width = is_farm ? random_.between(16.0F, 22.0F) : random_.between(9.0F, 13.0F);
    const float depth = is_farm ? random_.between(9.0F, 11.0F) : random_.between(8.0F, 10.0F);
    const float heading = (side > 0.0F ? 0.0F : std::numbers::pi_v<float>)+random_.between(-0.12F, 0.12F) +
                          (random_.chance(0.3F) ? 0.5F * std::numbers::pi_v<float> : 0.0F);
    place(at, heading, 0.45F);
    builder_.frame.translation() -= builder_.frame.linear() * Eigen::Vector3f(0.5F * width, 0.5F * depth, 0.0F);
    add_house(builder_, random_, style, width, depth);
  }

  Eigen::Vector2f tree_place(int kind) {
    const Eigen::Vector2f anywhere(random_.between(-1.0F, 1.0F) * land_.half_x,
                                   random_.between(-1.0F, 1.0F) * land_.half_y);
    if (kind == 1) {
      const float side = random_.chance(0.5F) ? 1.0F : -1.0F;
      return {anywhere.x(), land_.river_y(anywhere.x()) + side * random_.between(1.5F, 2.6F) * Land::kRiverHalf_m};
    }
    const FarmField& field =
        land_.fields[static_cast<std::size_t>(random_.below(static_cast<int>(land_.fields.size())))];
    if (kind == 2 && !sites_.empty()) {
      const Eigen::Vector2f& site = sites_[static_cast<std::size_t>(random_.below(static_cast<int>(sites_.size())))];
      return site + Eigen::Vector2f(random_.between(-22.0F, 22.0F), random_.between(-18.0F, 18.0F));
    }
    if (kind == 3 || field.use != LandUse::kWood) {  // a row along the field's edge
      if (kind == 0) return {1e9F, 0.0F};
      return {random_.between(field.x0, field.x1), field.y0 + random_.between(-1.0F, 1.0F)};
    }
    return {random_.between(field.x0 + 3.0F, field.x1 - 3.0F), random_.between(field.y0 + 3.0F, field.y1 - 3.0F)};
  }

  void add_survey() {
    const double reach_x = static_cast<double>(land_.half_x) - 20.0, reach_y = static_cast<double>(land_.half_y) - 30.0;
    const int lines = std::max(2, 1 + static_cast<int>(std::round(2.0 * reach_y / options_.survey_spacing_m)));
    std::vector<Eigen::Vector2d> corners;
    double x = -reach_x;
    for (int i = 0; i < lines; ++i) {
      const double y = -reach_y + 2.0 * reach_y * i / (lines - 1);
      corners.emplace_back(x, y);
      x = -x;
      corners.emplace_back(x, y);
    }
    const double altitude = options_.survey_altitude_m;
    builder_.mesh.routes = {rounded_route("survey", corners, false, 0.5 * options_.survey_spacing_m,
                                          [altitude](double, double) { return altitude; })};
  }

  const AerialOptions& options_;
  SceneRandom random_;
  Land land_;
  SceneBuilder builder_;
  std::vector<Eigen::Vector2f> sites_;
};

}  // namespace

Scene make_aerial(const AerialOptions& options) {
  check(options);
  StripBuilder strip(options);
  strip.add_buildings();
  strip.add_trees();
  strip.add_cars();
  return strip.finish();
}

}  // namespace cmap
