#include "clouds/las/las_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cmap {
namespace {

/// Whether two descriptions contradict each other; what only one of them says does not.
bool disagree(const CoordinateUnits& a, const CoordinateUnits& b) {
  const auto differ = [](std::optional<double> u, std::optional<double> v) { return u && v && *u != *v; };
  if (!a.says_something() || !b.says_something()) return false;
  return a.angular != b.angular || differ(a.horizontal_m, b.horizontal_m) || differ(a.vertical_m, b.vertical_m);
}

/// The command that projects a map around this place, to the UTM zone there.
std::string projecting_command(const std::string& in, double longitude_deg, double latitude_deg) {
  const int zone = std::clamp(static_cast<int>(std::floor((longitude_deg + 180.0) / 6.0)) + 1, 1, 60);
  const std::size_t dot = in.find_last_of('.');
  return fmt::format(
      "pdal translate {} {}_utm.las reprojection --filters.reprojection.out_srs=EPSG:{} "
      "--writers.las.scale_x=0.001 --writers.las.scale_y=0.001 --writers.las.scale_z=0.001 "
      "--writers.las.offset_x=auto --writers.las.offset_y=auto",
      in, in.substr(0, dot), (latitude_deg < 0.0 ? 32700 : 32600) + zone);
}

}  // namespace

CoordinateUnits las_units(const LasHeader& header, const LasRecords& records, FileInfo& info) {
  CoordinateUnits wkt, keys;
  if (!records.wkt.empty()) wkt = units_from_wkt(records.wkt);
  if (!records.geo_keys.empty()) keys = units_from_geo_keys(records.geo_keys, records.geo_doubles);
  for (const CoordinateUnits* units : {&wkt, &keys}) {
    if (units->problem.empty()) continue;
    info.warnings.push_back({"coordinate_system", "its coordinate system is described by " + units->problem});
  }
  const bool by_wkt = wkt.says_something() && (header.wkt_counts || !keys.says_something());
  if (disagree(wkt, keys)) {
    info.warnings.push_back({"coordinate_system", fmt::format("its WKT and its GeoKeys disagree about the units; {} "
                                                              "count, as the header says",
                                                              by_wkt ? "those of the WKT" : "those of the GeoKeys")});
  }
  return by_wkt ? wkt : keys;
}

std::array<double, 3> meters_per_unit(const CoordinateUnits& units, FileInfo& info) {
  const double xy_m = units.horizontal_m.value_or(1.0);
  const double z_m = units.vertical_m.value_or(xy_m);
  if (xy_m == z_m && xy_m != 1.0) {
    info.notes.push_back(fmt::format("{} became meters{}", unit_name(xy_m),
                                     units.vertical_m ? "" : ", also of z, whose unit the file does not name"));
  } else if (xy_m != z_m) {
    const auto became = [](double unit_m) {
      return unit_m == 1.0 ? std::string("meters already") : fmt::format("{} that became meters", unit_name(unit_m));
    };
    info.notes.push_back(fmt::format("x and y: {}; z: {}", became(xy_m), became(z_m)));
  }
  return {xy_m, xy_m, z_m};
}

void refuse_degrees(const ByteSource& source, const CoordinateUnits& units, const PointCloud& cloud, FileInfo& info) {
  if (!units.angular) return;
  double farthest = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    farthest = std::max(farthest, cloud.world(i).head<2>().cwiseAbs().maxCoeff());
  }
  const std::string system = units.system.empty() ? "" : fmt::format(" ({})", units.system);
  if (farthest > 360.0) {
    info.warnings.push_back({"coordinate_system", fmt::format("the file says that its coordinates are degrees{}, but "
                                                              "they reach {:g}: taken as meters",
                                                              system, farthest)});
    return;
  }
  const Eigen::Vector3d place = cloud.world(0);
  throw UnsupportedError(
      fmt::format("{}: its coordinates are degrees of longitude and latitude{}, and distances need "
                  "meters; project it first, for example: {}",
                  source.name(), system, projecting_command(source.name(), place.x(), place.y())));
}

}  // namespace cmap
