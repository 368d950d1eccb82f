#pragma once

#include <optional>

namespace cmap {

/// Meters per unit of length, by its EPSG code (9001 meter, 9002 foot, 9003 US survey foot ...).
std::optional<double> epsg_length_m(int unit);

/// Unit of a projected, or of a vertical, coordinate system by its EPSG code: from a list of those that are not in
/// meters (EPSG 11.022). Writers that leave the unit out leave only the code.
double epsg_projected_unit_m(int system);
double epsg_vertical_unit_m(int system);

}  // namespace cmap
