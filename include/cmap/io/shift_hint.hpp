#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace cmap {

/// A shift between a map's coordinates and those of its surroundings that is written down somewhere; never applied by a
/// reader.
struct ShiftHint {
  Eigen::Vector3d shift_m;      ///< added to the stored coordinates; comments also mean its negative
  std::string where;            ///< "the comment 'IGN offset Pos 1 2 3' of map.ply", "map_offset.xyz"
  bool is_approximate = false;  ///< a place on the globe, whose north and scale are not those of a projection
};

/// The shifts that a map's own comments name, or files beside it: NAME_offset.xyz (Pix4D), coords.txt and
/// odm_georeferencing_model_geo.txt (OpenDroneMap), reference_lla.json (OpenSfM; as UTM). Looks at no more than the
/// first 64 KiB of a file; what cannot be read is no hint. Throws nothing.
std::vector<ShiftHint> find_shift_hints(const std::filesystem::path& map);

/// UTM easting and northing (m, WGS 84, the zone of the longitude, southern northings from 10,000,000) of a place in
/// degrees, to a millimeter within the zone.
Eigen::Vector2d utm_of(double latitude_deg, double longitude_deg);

}  // namespace cmap
