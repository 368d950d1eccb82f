#include "clouds/foreign_formats.hpp"

#include <zlib.h>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace foreign_formats_test {

using namespace std::string_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string gzip(std::string content) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(content.size() + 100, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(content.data());
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

/// The first local header of a ZIP file, and the start of the member.
std::string zip(std::string_view member) {
  Bytes bytes("PK\x03\x04");
  bytes.put(U16{20}, U16{0}, U16{0}, U16{0}, U16{0}, std::uint32_t{0}, std::uint32_t{4}, std::uint32_t{4});
  bytes.put(static_cast<U16>(member.size()), U16{0}).text(member).text("data");
  return bytes.str();
}

TEST(ForeignFormats, SplatsInAnyFileLeadToPoints) {
  std::string header = "NGSP";
  header += std::string(60, '\1');
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const std::pair<const char*, std::string> kFiles[] = {
      {"a.ply", ply + "property float f_dc_0\nend_header\n1 2 3 4\n"},
      {"a.ply", ply + "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float f_dc_0\nproperty "
                      "float f_dc_1\nproperty float f_dc_2\nend_header\n1 2 3 4 5 6 7 8 9\n"},
      {"a.ply",
       "ply\nformat binary_little_endian 1.0\nelement chunk 1\nproperty float min_x\nelement vertex 256\n"
       "property uint packed_position\nend_header\n"},
      {"a.ply", "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty uint packed_position\r\nend_header\r\n1\r\n"},
      {"a.csv", "x,y,z,nx,ny,nz,f_dc_0,f_dc_1,f_dc_2,opacity\n1,2,3,0,0,0,0.1,0.2,0.3,5\n"},
      {"a.spz", gzip(header)},
      {"renamed", gzip(header)},
      {"a.spz", header},
      {"renamed.bin", header},
      {"a.sog", zip("meta.json")},
      {"renamed.zip", zip("means_l.webp")},
      {"meta.json", R"({"version":2,"count":9,"means":{"files":["means_l.webp"]},"sh0":{}})"},
      {"a.splat", "\x01\x02\x03\x04"s},
      {"a.ksplat", "\x00\x01\x00\x00"s},
  };
  for (const auto& [name, content] : kFiles) {
    EXPECT_THAT(refusal(name, content), HasSubstr(splat_hint())) << name;
  }
  EXPECT_THAT(splat_hint(), AllOf(HasSubstr("Gaussian splats"), HasSubstr("0.5 + 0.28209479 * f_dc"),
                                  HasSubstr("opacity"), HasSubstr("0..1")));
}

TEST(ForeignFormats, OnlyAPropertyMakesASplat) {
  const auto file = read_content("a.ply",
                                 "ply\nformat ascii 1.0\ncomment made from f_dc_0, property f_dc_1\nelement vertex 1\n"
                                 "property float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n");
  EXPECT_EQ(file.info.points, 1U);
}

TEST(ForeignFormats, NamedByContent) {
  std::string tar(600, '\0');
  tar.replace(257, 5, "ustar");
  std::string stl(84 + 50, '\0');
  stl[80] = 1;
  const std::pair<std::string, const char*> kFiles[] = {
      {"ASTM-E57....", "E57"},
      {gzip("ply\nformat"), "gzip; decompress"},
      {"\x1f\x8b\x08", "gzip; decompress"},
      {"\x28\xb5\x2f\xfd...", "zstd"},
      {"\xfd"
       "7zXZ",
       "with xz"},
      {"BZh91AY", "bzip2"},
      {"7z\xbc\xaf\x27\x1c..", "7z archive"},
      {"Rar!\x1a\x07..", "RAR archive"},
      {tar, "tar archive"},
      {zip("maps/cloud.ply"), "'maps/cloud.ply'); unpack it"},
      {zip("archive/data.pkl"), "PyTorch"},
      {zip("[Content_Types].xml"), "Office"},
      {"PK\x05\x06"s + std::string(18, '\0'), "ZIP archive without a member"},
      {"#ROSBAG V2.0\n", "ROS bag"},
      {"\x89MCAP0\r\n", "MCAP"},
      {"SQLite format 3\0..."s, "SQLite"},
      {"\x89HDF\r\n", "HDF5"},
      {"PAR1\x15\x04", "Parquet"},
      {"ARROW1\0\0"s, "Arrow"},
      {"FEA1\0\0"s, "Feather"},
      {"\xd4\xc3\xb2\xa1\x02\0"s, "pcap"},
      {"\x0a\x0d\x0d\x0a\x1c\0"s, "pcapng"},
      {"DRACO\x02\x02", "Draco"},
      {"glTF\x02\0"s, "glTF"},
      {R"({"asset":{"version":"2.0"},"meshes":[]})", "glTF"},
      {R"({"points":[]})", "JSON"},
      {"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n", "legacy VTK"},
      {"<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">\n", "VTK XML"},
      {"<VTKFile type=\"UnstructuredGrid\">\n", "VTK XML"},
      {"<?xml version=\"1.0\"?>\n<x/>\n", "XML"},
      {"solid cube\n facet normal 0 0 1\n", "mesh (STL); sample"},
      {stl, "mesh (STL); sample"},
      {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "mesh (OFF); sample"},
      {"COFF 3 1 0\n", "mesh (OFF)"},
      {"VERTEX_SE3:QUAT 0 1 2 3 0 0 0 1\n", "pose graph"},
      {"\xff\xfe\x31\0\x20\0"s, "UTF-16"},
      {"\x7f\x45LF", "program"},
      {"version https://git-lfs.github.com/spec/v1\n", "Git LFS pointer"},
      {"<!DOCTYPE html>", "web page"},
  };
  for (const auto& [content, message] : kFiles) {
    EXPECT_THAT(refusal("a.xyz", content), AllOf(HasSubstr(message), HasSubstr("can be read"))) << content;
  }
}

TEST(ForeignFormats, NamedByExtension) {
  const std::pair<const char*, const char*> kFiles[] = {
      {"a.FLS", "FARO"},  {"a.rcp", "ReCap"},      {"a.rcs", "ReCap"},      {"a.las", "LASF"},  {"a.laz", "LASF"},
      {"a.rxp", "RIEGL"}, {"a.stl", "mesh (STL)"}, {"a.off", "mesh (OFF)"}, {"a.pkl", "pickle"}};
  for (const auto& [name, message] : kFiles) {
    EXPECT_THAT(refusal(name, "\x01\x02\x03hello"), HasSubstr(message)) << name;
  }
}

TEST(ForeignFormats, NpzAndPointsAreNotForeign) {
  FileStart start;
  for (const std::string& content : {zip("points.npy"), "1 2 3\n"s, "x y z\n1 2 3\n"s, "BZ 1 2\n"s}) {
    start.bytes = content;
    start.size = content.size();
    start.text = content[0] != 'P';
    EXPECT_EQ(foreign_content(start), std::nullopt) << content;
  }
}

TEST(ForeignFormats, AnyStartOfAnyOfThemIsSafe) {
  for (const std::string& content : {gzip("NGSP...."), zip("meta.json"), std::string(84, 'x')}) {
    for (std::size_t n = 0; n <= content.size(); ++n) {
      FileStart start;
      start.bytes = std::string_view(content).substr(0, n);
      start.size = n;
      (void)foreign_content(start);
    }
  }
}

}  // namespace foreign_formats_test
}  // namespace cmap::testing
