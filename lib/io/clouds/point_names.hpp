#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cmap {

using ColumnTriple = std::array<std::size_t, 3>;

/// What the columns or fields of a point are, by the names that are in use: whatever the case, with units, quotes and
/// separators inside ("X [m]", "x_m", "//X"), and with synonyms (easting northing height, diffuse_red, Rf Gf Bf).
struct PointNames {
  std::optional<ColumnTriple> position;
  std::optional<ColumnTriple> color;        ///< red, green, blue
  std::optional<std::size_t> packed_color;  ///< rgb, rgba
  std::size_t n_color_channels = 0;         ///< of red, green, blue, where not all three are there
};

/// The first match of each kind, in the order of the synonyms.
PointNames find_point_names(std::span<const std::string> names);

/// The name without quotes and comment marks, in lower case, letters and digits alone: "X [m]" is "xm".
std::string plain_name(std::string_view name);

/// Whether these names are those of Gaussian splats: f_dc_0 ..., whose colors are coefficients, or packed.
bool names_splats(std::span<const std::string> names);

/// Whether they give places as longitude and latitude.
bool names_degrees(std::span<const std::string> names);

/// "x_mm", "x [ft]": the unit that the name of a coordinate says, where it is not meters; empty otherwise.
std::string_view unit_in_name(std::string_view name);

}  // namespace cmap
