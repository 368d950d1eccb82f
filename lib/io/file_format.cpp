#include "io/file_format.hpp"

#include <algorithm>
#include <cctype>

#include "io/line_reader.hpp"

namespace cmap {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kReadable = "PLY, PCD, LAS, NPY, NPZ and text (x y z [r g b]) can be read";

struct Foreign {
  std::string_view magic;
  std::string_view message;
};

constexpr Foreign kForeign[] = {
    {"ASTM-E57"sv, "is an E57 file (pdal translate in.e57 out.ply converts it)"},
    {"\x1f\x8b"sv, "is compressed with gzip; decompress it first"},
    {"\x28\xb5\x2f\xfd"sv, "is compressed with zstd; decompress it first"},
    {"\xfd"
     "7zXZ"sv,
     "is compressed with xz; decompress it first"},
    {"BZh"sv, "is compressed with bzip2; decompress it first"},
    {"#ROSBAG"sv, "is a ROS bag"},
    {"\x89HDF"sv, "is an HDF5 file"},
    {"\x89PNG"sv, "is a PNG image"},
    {"\xff\xd8\xff"sv, "is a JPEG image"},
    {"glTF"sv, "is a binary glTF model"},
    {"\x7f"
     "ELF"sv,
     "is a program"},
    {"version https://git-lfs"sv, "is a Git LFS pointer, not the file itself (git lfs pull fetches it)"},
    {"<!DOCTYPE"sv, "is a web page; the download probably failed"},
    {"<html"sv, "is a web page; the download probably failed"},
    {"{"sv, "looks like JSON"},
};

std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

bool is_text(std::string_view start) {
  return std::none_of(start.begin(), start.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && c != '\n' && c != '\r' && c != '\t' && c != '\v' && c != '\f';
  });
}

/// A PCD file may start with comments and with any of its keywords.
bool looks_like_pcd(std::string_view start) {
  while (!start.empty()) {
    const std::string_view line = start.substr(0, start.find('\n'));
    if (line.starts_with("# .PCD")) return true;
    if (line.starts_with("VERSION ") || line.starts_with("FIELDS ")) return true;
    if (!line.starts_with("#") && line.find_first_not_of(" \t\r") != std::string_view::npos) return false;
    start.remove_prefix(std::min(start.size(), line.size() + 1));
  }
  return false;
}

}  // namespace

FileFormat detect_format(ByteSource& source) {
  const auto bytes = source.peek(std::min<std::uint64_t>(4096, source.size()));
  const std::string_view start = without_byte_order_mark(
      {reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(4096, bytes.size())});
  if (start.starts_with("ply\n") || start.starts_with("ply\r")) return FileFormat::kPly;
  if (start.starts_with("LASF")) return FileFormat::kLas;
  if (start.starts_with("\x93NUMPY")) return FileFormat::kNpy;
  if (start.starts_with("PK\x03\x04")) return FileFormat::kNpz;
  if (looks_like_pcd(start)) return FileFormat::kPcd;
  for (const Foreign& foreign : kForeign) {
    if (start.starts_with(foreign.magic)) source.fail("{}; {}", foreign.message, kReadable);
  }
  const std::string extension = extension_of(source.name());
  if (extension == ".ply") return FileFormat::kPly;
  if (extension == ".pcd") return FileFormat::kPcd;
  if (extension == ".las" || extension == ".laz") source.fail("does not start with 'LASF', as a LAS file does");
  if (extension == ".obj" || extension == ".stl" || extension == ".off") {
    source.fail("is a mesh ({}), not a point cloud; {}", extension, kReadable);
  }
  if (!is_text(start)) source.fail("is of no known format; {}", kReadable);
  return FileFormat::kText;
}

}  // namespace cmap
