#include "clouds/cloud_format.hpp"
#include "clouds/numpy/npy_points.hpp"

namespace cmap {
namespace {

PointCloud read_npy_cloud(ByteSource& source, FileInfo& info) {
  const NpyArray array = read_npy(source);
  info.format = array.header.is_record() ? "NPY records" : fmt::format("NPY {}", array.header.type_text());
  const NpyPoints points = points_of(array, info);
  CloudBuilder builder(source, points.layout, points.n);
  append_points(points, 0, points.n, builder);
  return builder.finish(info);
}

}  // namespace

namespace formats {

extern constinit const CloudFormat npy{
    .name = "NPY",
    .listed = "NPY",
    .by_content = [](const FileStart& start) { return start.bytes.starts_with("\x93NUMPY"); },
    .read = without_options<read_npy_cloud>};

}  // namespace formats

}  // namespace cmap
