#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// Where a ray meets a scene first, without its color: what a LiDAR needs.
struct SurfaceHit {
  double distance_m = 0.0;                           ///< along the ray, exact to 1e-4 m
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, towards the ray's origin; world frame
  float reflectivity = 0.0F;  ///< of near infrared light, [0,1]; 0: water, from which no LiDAR gets a return
};

/// The same with the color that every camera sees there, whatever its position: RGB in [0,1], display-referred (sRGB).
struct SceneHit : SurfaceHit {
  RgbF color{};
};

/// A way through a scene: a polyline with rounded corners, points at most 1 m apart.
struct SceneRoute {
  std::string name;
  bool closed = false;                  ///< the last point leads back to the first
  std::vector<Eigen::Vector3d> points;  ///< world frame; on the ground or floor, for "survey" at flight altitude
};

struct SceneData;

/// Surfaces with color under a fixed light. Immutable, cheap to copy; all functions are thread-safe, and their results
/// do not depend on the number of threads.
class Scene {
 public:
  explicit Scene(std::shared_ptr<const SceneData> data);

  /// The first surface along the ray, none within max_distance_m. World frame; `direction` is a unit vector.
  std::optional<SceneHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                               double max_distance_m) const;

  /// The same without the color, which costs more than the ray.
  std::optional<SurfaceHit> probe(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  double max_distance_m) const;

  /// What a camera sees where no surface is: RGB in [0,1], `direction` a unit vector of the world frame.
  RgbF sky(const Eigen::Vector3d& direction) const;

  /// Of all surfaces, world frame.
  Box3d bounds() const;

  /// Height z of the ground, floor or road under (x, y), without what stands on it. Of a mesh scene: of its lowest
  /// surface there; the lowest z of the scene where there is none.
  double ground_height_m(double x, double y) const;

  /// The ways that suit this scene: a town has "street" and "block_loop", a floor "corridor_loop", a strip "survey";
  /// a mesh has none.
  const std::vector<SceneRoute>& routes() const;

  /// The route of that name. Throws UsageError naming those there are.
  const SceneRoute& route(std::string_view name) const;

  const SceneData& data() const { return *data_; }

 private:
  std::shared_ptr<const SceneData> data_;
};

/// A town: a grid of streets with sidewalks, blocks lined by houses, yards, parked cars and trees on undulating ground.
/// Streets cross at right angles along x and y; the scene is centered on the origin, z up.
struct TownOptions {
  std::uint64_t seed = 1;
  int blocks_x = 3, blocks_y = 3;  ///< blocks of houses, >= 3; the loop goes around the one in the middle
  double block_x_m = 64.0;         ///< size of a block, from sidewalk to sidewalk, >= 30
  double block_y_m = 48.0;
  double street_width_m = 13.0;  ///< between blocks, with both sidewalks, >= 8
  double undulation_m = 0.8;     ///< amplitude of the ground's hills, some 80 m long, >= 0
  double trees_per_100m = 7.0;   ///< along each side of a street, >= 0
  double cars_per_100m = 7.0;    ///< parked, along each side of a street, >= 0
};

/// One floor of an office building: a corridor around a core, rooms with furniture on both sides, doors, a ceiling.
struct IndoorOptions {
  std::uint64_t seed = 1;
  double length_m = 36.0, width_m = 26.0;  ///< outer size, each >= 18
  double corridor_width_m = 2.2;           ///< >= 1.5
  double ceiling_m = 2.8;                  ///< >= 2.4
  double furniture = 1.0;                  ///< 0: empty rooms; 1: as furnished as an office is
};

/// A strip of land as a drone sees it: fields of different crops, a road, a river, farms and hamlets, trees.
struct AerialOptions {
  std::uint64_t seed = 1;
  double length_m = 500.0, width_m = 260.0;  ///< each >= 150
  double relief_m = 6.0;                     ///< amplitude of the hills, >= 0
  int buildings = 40;                        ///< >= 0
  int trees = 500;                           ///< >= 0
  double survey_altitude_m = 80.0;           ///< of the route "survey" above the mean ground, > 20
  double survey_spacing_m = 50.0;            ///< between its lines, > 5
};

/// Deterministic for the options. Throw UsageError naming an option outside of its range.
Scene make_town(const TownOptions& options);
Scene make_indoor(const IndoorOptions& options);
Scene make_aerial(const AerialOptions& options);

/// A triangle mesh as the scene: PLY (any encoding, polygons are split into fans) with vertex colors, or OBJ with
/// colored vertices or a material's image texture (map_Kd, then Kd); lit gray where there is no color, else the colors
/// as they are. z is up. Throws InputError naming file and line (byte in binary data).
Scene read_mesh_scene(const std::filesystem::path& path);

/// Points drawn uniformly over the area of all surfaces, with their colors (8 bit): round(area * density) points.
/// Throws UsageError unless 0 < points_per_m2, or if that were more than 2^31 points.
PointCloud sample_surface(const Scene& scene, double points_per_m2, std::uint64_t seed);

}  // namespace cmap
