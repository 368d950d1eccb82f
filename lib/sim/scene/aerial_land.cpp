#include "scene/aerial_land.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cmap {
namespace {

float to_cell(float x) { return Land::kCell_m * std::round(x / Land::kCell_m); }

/// Lines from -half to half, between `least` and `most` apart.
std::vector<float> cut(SceneRandom& random, float half, float least, float most) {
  std::vector<float> lines = {-half};
  while (half - lines.back() > most) lines.push_back(to_cell(lines.back() + random.between(least, most)));
  if (half - lines.back() < 0.5F * least) lines.pop_back();
  lines.push_back(half);
  return lines;
}

struct Crop {
  RgbF plants, soil;
  float row_m;
};

Surface field_surface(SceneRandom& random, const FarmField& field) {
  constexpr std::array<Crop, 8> kCrops = {{{{0.80F, 0.68F, 0.38F}, {0.60F, 0.48F, 0.28F}, 1.2F},    // wheat
                                           {{0.84F, 0.76F, 0.18F}, {0.42F, 0.46F, 0.16F}, 1.6F},    // rape
                                           {{0.28F, 0.46F, 0.17F}, {0.40F, 0.34F, 0.22F}, 1.9F},    // maize
                                           {{0.38F, 0.56F, 0.22F}, {0.44F, 0.36F, 0.26F}, 1.5F},    // beets
                                           {{0.52F, 0.41F, 0.30F}, {0.38F, 0.29F, 0.21F}, 2.4F},    // ploughed
                                           {{0.70F, 0.70F, 0.44F}, {0.50F, 0.48F, 0.28F}, 1.3F},    // barley
                                           {{0.48F, 0.40F, 0.60F}, {0.46F, 0.44F, 0.30F}, 2.6F},    // lavender
                                           {{0.33F, 0.50F, 0.26F}, {0.30F, 0.38F, 0.18F}, 3.2F}}};  // vegetables
  Surface surface;
  surface.seed = random.bits();
  surface.origin = {field.x0, field.y0, 0.0F};
  if (field.use == LandUse::kCrop) {
    const Crop& crop = kCrops[static_cast<std::size_t>(random.below(8))];
    surface.material = Material::kCrop;
    surface.base = crop.plants;
    surface.accent = crop.soil;
    surface.width = crop.row_m;
    const float angle = random.chance(0.7F) ? random.between(-0.15F, 0.15F) : 1.5708F + random.between(-0.15F, 0.15F);
    surface.u_axis = {std::cos(angle), std::sin(angle), 0.0F};
    surface.v_axis = {-std::sin(angle), std::cos(angle), 0.0F};
  } else {
    surface.material = Material::kGrass;
    const bool is_wood = field.use == LandUse::kWood;
    surface.base = is_wood ? RgbF{0.26F, 0.33F, 0.16F} : RgbF{0.38F, 0.52F, 0.22F};
    surface.accent = is_wood ? RgbF{0.36F, 0.28F, 0.18F} : RgbF{0.54F, 0.52F, 0.28F};
  }
  return surface;
}

/// Land within a field, in cells that match those of its neighbors.
void add_field(SceneBuilder& builder, SceneRandom& random, const Land& land, const FarmField& field) {
  const std::uint32_t surface = builder.add(field_surface(random, field));
  const auto at = [&](int i, int j) {
    const float x = std::min(field.x0 + static_cast<float>(i) * Land::kCell_m, field.x1);
    const float y = std::min(field.y0 + static_cast<float>(j) * Land::kCell_m, field.y1);
    return Eigen::Vector3f(x, y, land.height(x, y));
  };
  const int nx = static_cast<int>(std::ceil((field.x1 - field.x0) / Land::kCell_m - 1e-3F));
  const int ny = static_cast<int>(std::ceil((field.y1 - field.y0) / Land::kCell_m - 1e-3F));
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) builder.quad(surface, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
}

/// A ribbon on the ground from `from` to `to`.
void add_ribbon(SceneBuilder& builder, const Land& land, Surface look, const Eigen::Vector2f& from,
                const Eigen::Vector2f& to, float half_width, float above) {
  const Eigen::Vector2f along = (to - from).normalized(), left(-along.y(), along.x());
  look.origin = {from.x(), from.y(), 0.0F};
  look.u_axis = {along.x(), along.y(), 0.0F};
  look.v_axis = {left.x(), left.y(), 0.0F};
  look.width = (to - from).norm();
  look.height = 2.0F * half_width;
  const std::uint32_t surface = builder.add(look);
  const int n = static_cast<int>(std::ceil(look.width / Land::kCell_m));
  const auto at = [&](int i, float side) {
    const Eigen::Vector2f p =
        from + (to - from) * (static_cast<float>(i) / static_cast<float>(n)) + side * half_width * left;
    return Eigen::Vector3f(p.x(), p.y(), land.height(p.x(), p.y()) + above);
  };
  for (int i = 0; i < n; ++i) builder.quad(surface, at(i, -1), at(i + 1, -1), at(i + 1, 1), at(i, 1));
}

void add_roads(SceneBuilder& builder, SceneRandom& random, const Land& land) {
  Surface asphalt;
  asphalt.material = Material::kAsphalt;
  asphalt.base = {0.42F, 0.42F, 0.43F};
  asphalt.seed = random.bits();
  add_ribbon(builder, land, asphalt, {-land.half_x, land.road_y}, {land.half_x, land.road_y}, Land::kRoadHalf_m, 0.08F);
  Surface gravel;
  gravel.material = Material::kGravel;
  gravel.base = {0.66F, 0.60F, 0.50F};
  std::vector<float> tracks;
  for (const FarmField& field : land.fields) tracks.push_back(field.x1);
  std::sort(tracks.begin(), tracks.end());
  tracks.erase(std::unique(tracks.begin(), tracks.end()), tracks.end());
  for (const float x : tracks) {
    if (x > land.half_x - 1.0F) continue;
    gravel.seed = random.bits();
    const float end = land.river_y(x) - 1.8F * Land::kRiverHalf_m;
    add_ribbon(builder, land, gravel, {x, -land.half_y}, {x, land.road_y - Land::kRoadHalf_m}, 1.6F, 0.18F);
    add_ribbon(builder, land, gravel, {x, land.road_y + Land::kRoadHalf_m}, {x, end}, 1.6F, 0.18F);
  }
}

void add_water(SceneBuilder& builder, SceneRandom& random, const Land& land) {
  Surface water;
  water.material = Material::kWater;
  water.base = {0.16F, 0.28F, 0.30F};
  water.accent = {0.26F, 0.38F, 0.34F};
  water.seed = random.bits();
  const std::uint32_t surface = builder.add(water);
  // Wider than the river: its banks hide the rest.
  const float reach = 2.0F * Land::kRiverHalf_m, step = 5.0F;
  const auto at = [&](float x, float side) {
    const float y = std::min(land.river_y(x) + side * reach, land.half_y);
    return Eigen::Vector3f(x, y, land.water_z);
  };
  for (float x = -land.half_x; x < land.half_x; x += step) {
    const float end = std::min(x + step, land.half_x);
    builder.quad(surface, at(x, -1), at(end, -1), at(end, 1), at(x, 1));
  }
}

}  // namespace

Land::Land(const AerialOptions& options, SceneRandom& random)
    : half_x(to_cell(0.5F * static_cast<float>(options.length_m))),
      half_y(to_cell(0.5F * static_cast<float>(options.width_m))),
      road_y(-0.22F * half_y),
      water_z(0.0F),
      relief_(static_cast<float>(options.relief_m)),
      seed_(random.bits()) {
  water_z = -0.4F * relief_ - 1.2F;
  divide(random);
}

float Land::hills(float x, float y) const {
  return relief_ * (2.0F * fractal_noise(x / 130.0F, y / 130.0F, 3, seed_) - 1.0F);
}

float Land::river_y(float x) const {
  return half_y * (0.52F + 0.26F * (2.0F * value_noise(x / 120.0F, 0.5F, seed_ + 9) - 1.0F));
}

float Land::height(float x, float y) const {
  // Level across the road, and down to the river's bed.
  const float from_road = std::abs(y - road_y);
  const float land = lerp(hills(x, road_y), hills(x, y), smooth_step(6.0F, 40.0F, from_road));
  const float from_river = std::abs(y - river_y(x));
  const float bed = water_z - 1.5F;
  return lerp(bed, std::max(land, water_z + 0.8F), smooth_step(0.5F * kRiverHalf_m, 1.7F * kRiverHalf_m, from_river));
}

bool Land::is_dry(float x, float y, float clearance) const {
  return std::abs(y - river_y(x)) > 1.7F * kRiverHalf_m + clearance && std::abs(y - road_y) > kRoadHalf_m + clearance;
}

void Land::divide(SceneRandom& random) {
  const std::vector<float> columns = cut(random, half_x, 55.0F, 100.0F);
  for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
    const std::vector<float> rows = cut(random, half_y, 35.0F, 75.0F);
    for (std::size_t j = 0; j + 1 < rows.size(); ++j) {
      const bool at_road = rows[j] < road_y + 25.0F && rows[j + 1] > road_y - 25.0F;
      const float dice = random.unit();
      const LandUse use = at_road        ? (dice < 0.8F ? LandUse::kMeadow : LandUse::kCrop)
                          : dice < 0.68F ? LandUse::kCrop
                          : dice < 0.84F ? LandUse::kMeadow
                                         : LandUse::kWood;
      fields.push_back({columns[i], columns[i + 1], rows[j], rows[j + 1], use});
    }
  }
}

void add_land(SceneBuilder& builder, SceneRandom& random, const Land& land) {
  for (const FarmField& field : land.fields) add_field(builder, random, land, field);
  add_roads(builder, random, land);
  add_water(builder, random, land);
}

}  // namespace cmap
