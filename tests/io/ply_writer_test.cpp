#include <limits>

#include "io/sample_clouds.hpp"

namespace cmap::testing {
namespace ply_writer_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(PlyWriter, RoundTripIsExact) {
  const TempFolder folder;
  for (const PlyEncoding encoding : {PlyEncoding::kAscii, PlyEncoding::kBinaryLittleEndian}) {
    for (const PointCloud& cloud : sample_clouds()) {
      write_ply(folder / "a.ply", cloud, {}, encoding);
      expect_same_cloud(read_point_cloud(folder / "a.ply").cloud, cloud);
    }
  }
}

TEST(PlyWriter, HeaderIsWhatOtherProgramsRead) {
  const TempFolder folder;
  PointCloud cloud;
  cloud.positions = {{1.0F, 2.5F, -3.0F}};
  cloud.colors = Array<Rgb8>{{255, 0, 7}};
  const std::vector<float> error{0.1F}, missing{std::numeric_limits<float>::quiet_NaN()};
  const std::vector<PointField> fields{{"scalar_distance_m", error}, {"scalar_lcr", missing}};
  write_ply(folder / "a.ply", cloud, fields, PlyEncoding::kAscii);
  EXPECT_EQ(read_bytes(folder / "a.ply"),
            "ply\nformat ascii 1.0\ncomment written by cmap\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            "property float scalar_distance_m\nproperty float scalar_lcr\nend_header\n1 2.5 -3 255 0 7 0.1 nan\n");
  write_ply(folder / "b.ply", cloud, fields);
  Bytes body;
  body.put(1.0F, 2.5F, -3.0F, U8{255}, U8{0}, U8{7}, error[0], missing[0]);
  const std::string bytes = read_bytes(folder / "b.ply");
  EXPECT_THAT(bytes, StartsWith("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_THAT(bytes, ::testing::EndsWith("end_header\n" + body.str()));
}

TEST(PlyWriter, WritesWorldCoordinatesInDouble) {
  const TempFolder folder;
  PointCloud cloud;
  cloud.origin = {500000, 4000000, 0};
  cloud.positions = {{0.25F, 0.5F, 1.0F}};
  write_ply(folder / "a.ply", cloud, {}, PlyEncoding::kAscii);
  EXPECT_THAT(read_bytes(folder / "a.ply"), HasSubstr("property double x"));
  EXPECT_THAT(read_bytes(folder / "a.ply"), HasSubstr("\n500000.25 4000000.5 1\n"));
}

TEST(PlyWriter, FieldsMustFit) {
  const TempFolder folder;
  PointCloud cloud;
  cloud.positions = {{1.0F, 2.0F, 3.0F}};
  const std::vector<float> one{1.0F}, two{1.0F, 2.0F};
  for (const PointField& field : {PointField{"short", two}, PointField{"with blank", one}, PointField{"", one}}) {
    EXPECT_THROW(write_ply(folder / "a.ply", cloud, std::array{field}), std::invalid_argument);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(PlyWriter, FailsOnAFullDisk) {
  const PointCloud cloud = sample_clouds().front();
  EXPECT_THROW(write_ply("/dev/full", cloud), OutputError);
  EXPECT_THROW(write_ply("/no/such/folder/a.ply", cloud), OutputError);
}

}  // namespace ply_writer_test
}  // namespace cmap::testing
