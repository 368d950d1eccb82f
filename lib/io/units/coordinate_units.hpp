#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cmap {

/// What the description of a coordinate system says about the unit of the coordinates.
struct CoordinateUnits {
  bool angular = false;                ///< x and y are angles: longitude and latitude
  std::optional<double> horizontal_m;  ///< meters per unit of x and y; unset: not said
  std::optional<double> vertical_m;    ///< the same of z
  std::string system;                  ///< name or code of the coordinate system, for messages; may be empty
  std::string problem;                 ///< what could not be understood, in words; empty: nothing

  bool says_something() const { return angular || horizontal_m || vertical_m; }
};

/// From well-known text: WKT 1 (OGC, ESRI) or WKT 2, one coordinate system or several one after another. Units count by
/// their factors, not by their names.
CoordinateUnits units_from_wkt(std::string_view wkt);

/// From a GeoTIFF key directory (16-bit numbers) and its floating-point parameters, both little-endian.
CoordinateUnits units_from_geo_keys(std::span<const std::byte> directory, std::span<const std::byte> doubles);

/// A length that is a meter or a foot but for rounding, exactly; any other as it is; none where it is no length.
std::optional<double> exact_unit_m(double factor);

/// For people: "feet", "US survey feet", "units of 0.01 m".
std::string unit_name(double unit_m);

}  // namespace cmap
