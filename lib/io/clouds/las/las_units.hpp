#pragma once

#include "clouds/las/las_records.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "units/coordinate_units.hpp"

namespace cmap {

/// What the file says about its units, by WKT or by GeoKeys as its header says, else by the other. Warns of what could
/// not be understood and where the two disagree.
CoordinateUnits las_units(const LasHeader& header, const LasRecords& records, FileInfo& info);

/// Meters per unit of x, y and z; says so in a note where it is not 1 throughout. Heights without a unit of their own
/// have that of x and y.
std::array<double, 3> meters_per_unit(const CoordinateUnits& units, FileInfo& info);

/// Throws UnsupportedError, naming a command that projects, for a cloud in degrees; warns where the file says degrees
/// but the coordinates are none.
void refuse_degrees(const ByteSource& source, const CoordinateUnits& units, const PointCloud& cloud, FileInfo& info);

}  // namespace cmap
