#include "clouds/cloud_format.hpp"

#include <sys/stat.h>

#include <thread>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace cloud_format_test {

using namespace std::string_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string_view format_of(std::string name, std::string_view content) {
  ByteSource source(std::move(name), std::as_bytes(std::span(content)));
  return detect_format(source).name;
}

TEST(CloudFormat, ContentComesBeforeTheExtension) {
  EXPECT_EQ(format_of("a.pcd", "ply\nformat"), "PLY");
  EXPECT_EQ(format_of("a.txt", "ply\r\nformat"), "PLY");
  EXPECT_EQ(format_of("a.txt", "\xef\xbb\xbfply\nformat"), "PLY");
  EXPECT_EQ(format_of("a.ply", "# .PCD v0.7\n"), "PCD");
  EXPECT_EQ(format_of("a.ply", "# x\n\n#y\nVERSION 0.7\n"), "PCD");
  EXPECT_EQ(format_of("a.ply", "# x\r\rVERSION 0.7\r"), "PCD");
  EXPECT_EQ(format_of("a.ply", "LASF"), "LAS");
  EXPECT_EQ(format_of("a.ply", "\x93NUMPY"), "NPY");
  EXPECT_EQ(format_of("a.npz", "PK\x03\x04"), "NPZ");
  EXPECT_EQ(format_of("a.txt", "2\n3\n0 0 0\n"), "PTX");
  EXPECT_EQ(format_of("a.txt", "v 1 2 3\n"), "OBJ");
  EXPECT_EQ(format_of("a", "1 2 3\n"), "text");
  EXPECT_EQ(format_of("a.bin", "1 2 3\n"), "text");
  EXPECT_EQ(format_of("a.txt", "2\n1 2 3\n4 5 6\n"), "text") << "one count only";
}

TEST(CloudFormat, ExtensionDecidesWhereContentDoesNot) {
  EXPECT_EQ(format_of("a.PLY", "plyx"), "PLY");
  EXPECT_EQ(format_of("a.pcd", "# mine\nSIZE 4\n"), "PCD");
  EXPECT_EQ(format_of("a.ptx", "2\n"), "PTX");
  EXPECT_EQ(format_of("a.obj", "# mine\n"), "OBJ");
  EXPECT_EQ(format_of("a.pcd.bin", "\x01\x02\x00\xff"s), "KITTI .bin");
}

TEST(CloudFormat, NamesWhatCanBeRead) {
  const std::string message = refusal("a.xyz", "\x01\x02\x00\xff"s);
  EXPECT_THAT(message, AllOf(HasSubstr("of no known format"), HasSubstr("; PLY, PCD, LAS, NPY,"),
                             HasSubstr(" and KITTI .bin can be read")));
}

TEST(CloudFormat, ProseIsNoPointCloud) {
  EXPECT_THAT(refusal("README", "This is\nno point cloud\n"), HasSubstr("line 2: 'no' is not a number"));
}

TEST(ReadPointCloud, TellsThePathAsGiven) {
  const TempFolder folder;
  const auto path = folder.write("a.xyz", "1 2 3\n");
  EXPECT_EQ(read_point_cloud(path).info.path, path.string());
  EXPECT_EQ(read_point_cloud(path).info.sha256, "");
  // sha256sum of "1 2 3\n"
  EXPECT_EQ(read_point_cloud(path, {.sha256 = true}).info.sha256,
            "1def07dbe06eeb097aafec8a40329937cd20c93a83634b8221ea2b41a894310c");
}

TEST(ReadPointCloud, SaysWhatIsWrongWithThePath) {
  EXPECT_THROW(read_point_cloud("/no/such.ply"), InputError);
  EXPECT_THROW(read_point_cloud("/tmp"), InputError);
  EXPECT_THROW(read_point_cloud(""), InputError);
}

TEST(ReadPointCloud, ReadsFromAPipe) {
  const TempFolder folder;
  const auto pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << "1 2 3\n4 5 6\n"; });
  const auto file = read_point_cloud(pipe, {.sha256 = true});
  writer.join();
  EXPECT_EQ(file.info.points, 2U);
  EXPECT_EQ(file.info.sha256.size(), 64U);
}

}  // namespace cloud_format_test
}  // namespace cmap::testing
