#include "clouds/file_format.hpp"

#include <algorithm>
#include <span>

#include "clouds/foreign_formats.hpp"
#include "clouds/format_readers.hpp"
#include "poses/transform_numbers.hpp"

namespace cmap {
namespace {

constexpr std::string_view kReadableFormats =
    "PLY, PCD, LAS, NPY, NPZ, PTS, PTX, KITTI .bin, COLMAP points3D, OpenSfM's "
    "reconstruction.json, OBJ without faces and text (x y z [r g b]) can be read";

bool is_ply(const FileStart& start) { return start.bytes.starts_with("ply\n") || start.bytes.starts_with("ply\r"); }
bool is_las(const FileStart& start) { return start.bytes.starts_with("LASF"); }
bool is_npy(const FileStart& start) { return start.bytes.starts_with("\x93NUMPY"); }
bool is_npz(const FileStart& start) { return start.bytes.starts_with("PK\x03\x04"); }

/// A PCD file may start with comments and with any of its keywords.
bool is_pcd(const FileStart& start) {
  for (const std::string_view line : start.lines(100)) {
    if (line.starts_with("# .PCD") || line.starts_with("VERSION ") || line.starts_with("FIELDS ")) return true;
    if (!line.starts_with("#") && line.find_first_not_of(" \t") != std::string_view::npos) return false;
  }
  return false;
}

/// Refuses a transform in brackets, as JSON or as NumPy prints it; rows of bare numbers are the text reader's.
void refuse_transform(const ByteSource& source, const FileStart& start) {
  constexpr std::size_t kMostBytes = 4096;
  if (!start.text || !start.whole || start.bytes.size() > kMostBytes || start.bytes.starts_with('#') ||
      start.bytes.find_first_of("[{") == std::string_view::npos) {
    return;
  }
  try {
    ByteSource bytes(source.name(), std::as_bytes(std::span(start.bytes)));
    parse_transform(bytes);
  } catch (const Error&) {
    return;
  }
  source.fail("holds one 4x4 or 3x4 matrix, a transform, and no point cloud; --transform takes it");
}

/// A reader that has no options.
template <auto reader>
PointCloud plain(ByteSource& source, FileInfo& info, const ReadOptions&) {
  return reader(source, info);
}

constexpr CloudFormat kByContent[] = {
    {"PLY", is_ply, plain<read_ply>},
    {"LAS", is_las, read_las, /*has_classes=*/true},
    {"NPY", is_npy, plain<read_npy_cloud>},
    {"NPZ", is_npz, plain<read_npz_cloud>},
    {"PCD", is_pcd, plain<read_pcd>},
    {"PTX", is_ptx, plain<read_ptx>},
    {"COLMAP text", is_colmap_text, plain<read_colmap_text>},
    {"COLMAP binary", is_colmap_binary, plain<read_colmap_binary>},
    {"OBJ", is_obj, plain<read_obj_points>},
    {"OpenSfM", is_opensfm, plain<read_opensfm>},
};

constexpr CloudFormat kByExtension[] = {
    {"PLY", [](const FileStart& start) { return start.extension == ".ply"; }, plain<read_ply>},
    {"PCD", [](const FileStart& start) { return start.extension == ".pcd"; }, plain<read_pcd>},
    {"text", [](const FileStart& start) { return start.text; }, plain<read_text>},
    {"KITTI .bin", [](const FileStart& start) { return start.extension == ".bin"; }, plain<read_kitti_bin>},
};

template <std::size_t n>
const CloudFormat* find(const CloudFormat (&formats)[n], const FileStart& start) {
  const auto found = std::find_if(formats, formats + n, [&](const auto& format) { return format.recognizes(start); });
  return found == formats + n ? nullptr : found;
}

}  // namespace

const CloudFormat& detect_format(ByteSource& source) {
  const FileStart start = file_start(source);
  refuse_transform(source, start);
  if (const auto what = foreign_content(start)) source.fail("{}; {}", *what, kReadableFormats);
  if (const CloudFormat* format = find(kByContent, start)) return *format;
  if (const auto what = foreign_extension(start)) source.fail("{}; {}", *what, kReadableFormats);
  if (const CloudFormat* format = find(kByExtension, start)) return *format;
  source.fail("is of no known format; {}", kReadableFormats);
}

}  // namespace cmap
