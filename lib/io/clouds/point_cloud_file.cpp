#include "cmap/io/point_cloud_file.hpp"

#include "clouds/cloud_format.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/io/byte_source.hpp"

namespace cmap {

std::uint64_t FileInfo::n_left_out() const {
  std::uint64_t n = 0;
  for (const LeftOut& some : left_out) n += some.n;
  return n;
}

PointCloudFile read_point_cloud(ByteSource& source, const ReadOptions& options) {
  PointCloudFile file;
  file.info.path = source.name();
  const CloudFormat& format = detect_format(source);
  if (!options.classes.empty() && !format.has_classes) {
    throw UnsupportedError(source.name() + ": classes were asked for, but only LAS files have them");
  }
  file.cloud = format.read(source, file.info, options);
  file.info.sha256 = source.finish_sha256();
  return file;
}

PointCloudFile read_point_cloud(const std::filesystem::path& path, const ReadOptions& options) {
  ByteSource source(path, options.sha256);
  return read_point_cloud(source, options);
}

std::pair<PointCloudFile, PointCloudFile> read_both(const std::filesystem::path& first,
                                                    const std::filesystem::path& second, const ReadOptions& options) {
  std::pair<PointCloudFile, PointCloudFile> files;
  parallel_tasks({[&] { files.first = read_point_cloud(first, options); },
                  [&] { files.second = read_point_cloud(second, options); }});
  return files;
}

}  // namespace cmap
