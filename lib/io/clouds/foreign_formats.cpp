#include "clouds/foreign_formats.hpp"

#include <zlib.h>

#include <algorithm>

#include "bytes/little_endian.hpp"
#include "clouds/cloud_format.hpp"

namespace cmap {
namespace formats {
extern const CloudFormat opensfm;
}

namespace {

using namespace std::string_view_literals;

constexpr std::string_view kSplats =
    "holds Gaussian splats, not points; make each splat's center a point of color RGB = 0.5 + 0.28209479 * f_dc, cut "
    "to 0..1, leaving out splats of low opacity (opacity, a logit, below 0), and give that as PLY (a packed file is "
    "unpacked to a PLY with f_dc_0 to f_dc_2 first, as splat-transform does)";

constexpr std::string_view kMesh = "; sample points on its surface first (CloudCompare and Open3D do)";

/// Bytes at a fixed place of a file.
struct Mark {
  std::size_t place;
  std::string_view bytes;
  std::string_view what;
};

constexpr Mark kMarks[] = {
    {0, "ASTM-E57"sv, "is an E57 file (pdal translate in.e57 out.ply converts it)"},
    {0, "\x28\xb5\x2f\xfd"sv, "is compressed with zstd; decompress it first"},
    {0, "\xfd\x37zXZ"sv, "is compressed with xz; decompress it first"},
    {0, "BZh"sv, "is compressed with bzip2; decompress it first"},
    {0, "\x04\x22\x4d\x18"sv, "is compressed with lz4; decompress it first"},
    {0, "7z\xbc\xaf\x27\x1c"sv, "is a 7z archive; unpack it first"},
    {0, "Rar!\x1a\x07"sv, "is a RAR archive; unpack it first"},
    {257, "ustar"sv, "is a tar archive; unpack it first"},
    {0, "PK\x05\x06"sv, "is a ZIP archive without a member"},
    {0, "NGSP"sv, kSplats},
    {0, "#ROSBAG"sv, "is a ROS bag, not a map; its clouds can be exported as PCD"},
    {0, "\x89MCAP"sv, "is an MCAP recording, not a map; its clouds can be exported as PCD"},
    {0, "SQLite format 3\0"sv, "is an SQLite database (of rosbag2 or COLMAP, say), not a map"},
    {0, "\x89HDF"sv, "is an HDF5 file"},
    {0, "PAR1"sv, "is a Parquet table; write its columns as CSV or PLY"},
    {0, "ARROW1"sv, "is an Arrow (Feather) table; write its columns as CSV or PLY"},
    {0, "FEA1"sv, "is a Feather table; write its columns as CSV or PLY"},
    {0, "\xd4\xc3\xb2\xa1"sv, "is a network capture (pcap) of a sensor's packets, not points"},
    {0, "\xa1\xb2\xc3\xd4"sv, "is a network capture (pcap) of a sensor's packets, not points"},
    {0, "\x4d\x3c\xb2\xa1"sv, "is a network capture (pcap) of a sensor's packets, not points"},
    {0, "\x0a\x0d\x0d\x0a"sv, "is a network capture (pcapng) of a sensor's packets, not points"},
    {0, "DRACO"sv, "is compressed with Draco; draco_decoder makes a PLY of it"},
    {0, "glTF"sv, "is a binary glTF model; export its vertices or a sample of its surface as PLY"},
    {0, "pnts"sv, "is a tile of 3D Tiles (pnts); export it as PLY or LAS"},
    {0, "b3dm"sv, "is a tile of 3D Tiles (b3dm, a mesh); export it as PLY"},
    {0, "# vtk DataFile"sv, "is a legacy VTK file; ParaView, PyVista and meshio write it as PLY"},
    {0, "Kaydara FBX"sv, "is an FBX model; export it as PLY"},
    {0, "BLENDER"sv, "is a Blender scene; export it as PLY"},
    {0, "PXR-USDC"sv, "is a USD scene; export it as PLY"},
    {0, "#usda"sv, "is a USD scene; export it as PLY"},
    {0, "MATLAB 5.0"sv, "is a MATLAB file; write its matrix as text, one point a line"},
    {0, "\x80\x04\x95"sv, "is a Python pickle; write its array with numpy.save"},
    {0, "\x80\x05\x95"sv, "is a Python pickle; write its array with numpy.save"},
    {0, "\x89PNG"sv, "is a PNG image"},
    {0, "\xff\xd8\xff"sv, "is a JPEG image"},
    {0, "II*\0"sv, "is a TIFF image"},
    {0, "MM\0*"sv, "is a TIFF image"},
    {0, "\x76\x2f\x31\x01"sv, "is an OpenEXR image"},
    {0, "%PDF"sv, "is a PDF document"},
    {0, "\x7f\x45LF"sv, "is a program"},
    {0, "version https://git-lfs"sv, "is a Git LFS pointer, not the file itself (git lfs pull fetches it)"},
    {0, "<!DOCTYPE"sv, "is a web page; the download probably failed"},
    {0, "<html"sv, "is a web page; the download probably failed"},
    {0, "VERTEX_SE"sv, "is a pose graph (g2o), not points"},
    {0, "EDGE_SE"sv, "is a pose graph (g2o), not points"},
};

/// Formats that are known by their names only.
constexpr std::pair<std::string_view, std::string_view> kExtensions[] = {
    {".las", "does not start with 'LASF', as a LAS file does"},
    {".laz", "does not start with 'LASF', as a LAZ file does"},
    {".e57", "does not start with 'ASTM-E57', as an E57 file does"},
    {".fls", "is a scan of FARO (FLS); export it as E57, PTX or LAS (FARO SCENE does)"},
    {".fws", "is a workspace of FARO SCENE; export its scans as E57, PTX or LAS"},
    {".rcp", "is a project of Autodesk ReCap (RCP); export its scans as E57, PTS or LAS"},
    {".rcs", "is a scan of Autodesk ReCap (RCS); export it as E57, PTS or LAS"},
    {".zfs", "is a scan of Zoller + Froehlich (ZFS); export it as E57 or PTX"},
    {".rxp", "is a scan of RIEGL (RXP); export it as LAS or E57"},
    {".rdbx", "is a database of RIEGL (RDBX); export it as LAS or E57"},
    {".lgs", "is a project of Leica (LGS); export it as E57, PTX or LAS"},
    {".cl3", "is a cloud of Topcon (CL3); export it as E57 or LAS"},
    {".ptg", "is a scan of Leica (PTG); export it as PTX or E57"},
    {".splat", kSplats},
    {".ksplat", kSplats},
    {".spz", kSplats},
    {".sog", kSplats},
    {".drc", "does not start with 'DRACO', as a Draco file does"},
    {".stl", "is a mesh (STL); sample points on its surface first (CloudCompare and Open3D do)"},
    {".off", "is a mesh (OFF); sample points on its surface first (CloudCompare and Open3D do)"},
    {".vtk", "does not start with '# vtk DataFile', as a VTK file does"},
    {".fbx", "is an FBX model; export it as PLY"},
    {".dae", "is a COLLADA model; export it as PLY"},
    {".dxf", "is a DXF drawing; export its points as text"},
    {".pkl", "is a Python pickle; write its array with numpy.save"},
    {".pt", "is a PyTorch file; write its array with numpy.save"},
    {".pth", "is a PyTorch file; write its array with numpy.save"},
    {".mat", "is a MATLAB file; write its matrix as text, one point a line"},
    {".raw", "holds raw numbers without a header; write them in a format that names its columns"},
};

using Answer = std::optional<std::string>;

bool contains(std::string_view text, std::string_view part) { return text.find(part) != std::string_view::npos; }

/// The first bytes of what a gzip file holds; fewer where it is damaged.
std::string gunzipped_start(std::string_view bytes, std::size_t n) {
  constexpr int kGzip = 16 + MAX_WBITS;
  z_stream stream{};
  if (inflateInit2(&stream, kGzip) != Z_OK) return {};
  std::string out(n, '\0');
  std::string in(bytes);
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(n);
  (void)inflate(&stream, Z_SYNC_FLUSH);
  out.resize(n - stream.avail_out);
  inflateEnd(&stream);
  return out;
}

Answer gzip(const FileStart& start) {
  if (!start.bytes.starts_with("\x1f\x8b\x08")) return std::nullopt;
  if (gunzipped_start(start.bytes, 4) == "NGSP") return std::string(kSplats);
  return "is compressed with gzip; decompress it first";
}

/// ZIP files of other things than arrays, by the name of their first member.
Answer zip(const FileStart& start) {
  constexpr std::size_t kHeaderBytes = 30;
  if (!start.bytes.starts_with("PK\x03\x04") || start.bytes.size() < kHeaderBytes) return std::nullopt;
  const auto n_name = load_little<std::uint16_t>(std::as_bytes(std::span(start.bytes)), 26);
  const std::string_view member = start.bytes.substr(kHeaderBytes, n_name);
  if (start.extension == ".sog" || member.ends_with(".webp") || member == "meta.json") return std::string(kSplats);
  if (member.ends_with("data.pkl")) return "is a PyTorch file; write its array with numpy.save";
  if (member == "[Content_Types].xml") return "is an Office document; save its table as CSV";
  if (start.extension == ".npz" || member.ends_with(".npy")) return std::nullopt;
  if (auto known = foreign_extension(start)) return known;
  return "is a ZIP archive (its first member is '" + std::string(member.substr(0, 60)) + "'); unpack it first";
}

Answer json_or_xml(const FileStart& start) {
  const std::size_t first = start.bytes.find_first_not_of(" \t\r\n");
  if (!start.text || first == std::string_view::npos || formats::opensfm.by_content(start)) return std::nullopt;
  const std::string_view content = start.bytes.substr(first);
  if (content.starts_with("{") || content.starts_with("[{") || content.starts_with("[\n")) {
    // The description of an unpacked .sog.
    if (contains(content, "\"means\"") && contains(content, "\"sh0\"")) return std::string(kSplats);
    if (contains(content, "\"asset\"") && contains(content, "\"meshes\"")) {
      return "is a glTF model; export its vertices or a sample of its surface as PLY";
    }
    if (contains(content, "\"octree\"") || contains(content, "\"hierarchy\"")) {
      return "is the description of a Potree cloud; export it as LAS";
    }
    return "looks like JSON";
  }
  if (!content.starts_with("<?xml") && !content.starts_with("<VTKFile")) return std::nullopt;
  if (contains(content, "<VTKFile")) return "is a VTK XML file; ParaView, PyVista and meshio write it as PLY";
  if (contains(content, "<COLLADA")) return "is a COLLADA model; export it as PLY";
  return "is an XML file";
}

Answer mesh(const FileStart& start) {
  constexpr std::size_t kStlHeader = 84;
  constexpr std::size_t kStlTriangle = 50;
  if (start.text) {
    const auto lines = start.lines(3);
    if (lines.empty()) return std::nullopt;
    if (lines[0].starts_with("solid") && lines.size() > 1 && contains(lines[1], "facet")) {
      return "is a mesh (STL)" + std::string(kMesh);
    }
    const auto words = tokens_of(lines[0], 1);
    constexpr std::string_view kOff[] = {"OFF", "COFF", "NOFF", "CNOFF", "STOFF"};
    if (!words.empty() && std::find(std::begin(kOff), std::end(kOff), words[0]) != std::end(kOff)) {
      return "is a mesh (OFF)" + std::string(kMesh);
    }
    return std::nullopt;
  }
  if (start.bytes.size() < kStlHeader) return std::nullopt;
  const auto n = load_little<std::uint32_t>(std::as_bytes(std::span(start.bytes)), 80);
  if (n == 0 || start.size != kStlHeader + std::uint64_t{n} * kStlTriangle) return std::nullopt;
  return "is a mesh (STL)" + std::string(kMesh);
}

/// The other files of a COLMAP model.
Answer colmap(const FileStart& start) {
  constexpr std::pair<std::string_view, std::string_view> kFiles[] = {{"cameras", "# Camera list with"},
                                                                      {"images", "# Image list with"},
                                                                      {"frames", "# Frame list with"},
                                                                      {"rigs", "# Rig calib list with"}};
  for (const auto& [what, comment] : kFiles) {
    const bool is_binary = !start.text && start.name == std::string(what) + ".bin";
    if (!is_binary && !start.bytes.starts_with(comment)) continue;
    return "holds the " + std::string(what) + " of a COLMAP model; its points are in points3D.txt or points3D.bin";
  }
  return std::nullopt;
}

/// Digits and most other signs take two bytes in UTF-16, one of them zero.
Answer utf16(const FileStart& start) {
  if (start.bytes.size() < 4) return std::nullopt;
  const bool little = start.bytes.starts_with("\xff\xfe") && start.bytes[3] == '\0';
  const bool big = start.bytes.starts_with("\xfe\xff") && start.bytes[2] == '\0';
  if (!little && !big) return std::nullopt;
  return "is UTF-16 text; save it as UTF-8";
}

}  // namespace

std::string_view splat_hint() { return kSplats; }

std::optional<std::string> foreign_content(const FileStart& start) {
  for (const auto look : {gzip, zip, colmap, mesh, utf16}) {
    if (auto answer = look(start)) return answer;
  }
  for (const Mark& mark : kMarks) {
    if (start.bytes.size() > mark.place && start.bytes.substr(mark.place).starts_with(mark.bytes)) {
      return std::string(mark.what);
    }
  }
  return json_or_xml(start);
}

std::optional<std::string> foreign_extension(const FileStart& start) {
  for (const auto& [extension, what] : kExtensions) {
    if (start.extension == extension) return std::string(what);
  }
  return std::nullopt;
}

}  // namespace cmap
