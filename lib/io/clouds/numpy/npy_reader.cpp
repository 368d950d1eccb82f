#include "clouds/format_readers.hpp"
#include "clouds/numpy/npy_points.hpp"

namespace cmap {

PointCloud read_npy_cloud(ByteSource& source, FileInfo& info) {
  const NpyArray array = read_npy(source);
  info.format = array.header.is_record() ? "NPY records" : fmt::format("NPY {}", array.header.type_text());
  const NpyPoints points = points_of(array, info);
  CloudBuilder builder(source, points.layout, points.n);
  append_points(points, 0, points.n, builder);
  return builder.finish(info);
}

}  // namespace cmap
