#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "clouds/las/las_header.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// What the variable-length records of a LAS file hold that matters here, undecoded.
struct LasRecords {
  std::string wkt;                     ///< empty: none
  std::vector<std::byte> geo_keys;     ///< GeoTIFF key directory; empty: none
  std::vector<std::byte> geo_doubles;  ///< and its floating-point parameters
  std::uint64_t extended_bytes = 0;    ///< how much of what follows the points is records
};

/// Reads the records before the points, without moving the source. A damaged record ends its list, with a warning: the
/// points do not need it. Throws InputError where one says that the points are compressed (LAZ).
LasRecords read_las_records(const ByteSource& source, const LasHeader& header, FileInfo& info);

/// Adds those behind the points, once the count of points is known to fit into the file.
void read_extended_records(const ByteSource& source, const LasHeader& header, LasRecords& records, FileInfo& info);

}  // namespace cmap
