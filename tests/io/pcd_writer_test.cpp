#include "io/sample_clouds.hpp"

namespace cmap::testing {
namespace pcd_writer_test {

using ::testing::EndsWith;
using ::testing::HasSubstr;

TEST(PcdWriter, RoundTripIsExactUpToEightBitColors) {
  const TempFolder folder;
  for (const PcdEncoding encoding : {PcdEncoding::kAscii, PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed}) {
    for (PointCloud& cloud : sample_clouds()) {
      write_pcd(folder / "a.pcd", cloud, encoding);
      if (std::holds_alternative<Array<Rgb16>>(cloud.colors) || std::holds_alternative<Array<RgbF>>(cloud.colors)) {
        cloud.colors = read_point_cloud(folder / "a.pcd").cloud.colors;
        EXPECT_TRUE(std::holds_alternative<Array<Rgb8>>(cloud.colors));
      }
      expect_same_cloud(read_point_cloud(folder / "a.pcd").cloud, cloud);
    }
  }
}

TEST(PcdWriter, WiderColorsAreRoundedToEightBits) {
  const TempFolder folder;
  PointCloud cloud;
  cloud.positions = {{1.0F, 2.0F, 3.0F}, {1.0F, 2.0F, 4.0F}};
  const Colors expected(Array<Rgb8>{{0, 128, 255}, {1, 0, 254}});
  cloud.colors = Array<Rgb16>{{0, 128 * 257 + 128, 65535}, {257, 128, 254 * 257 - 128}};
  write_pcd(folder / "a.pcd", cloud);
  EXPECT_EQ(read_point_cloud(folder / "a.pcd").cloud.colors, expected);
  cloud.colors = Array<RgbF>{{0.0F, 128.0F / 255.0F, 1.0F}, {1.2F / 255.0F, 0.4F / 255.0F, 253.6F / 255.0F}};
  write_pcd(folder / "a.pcd", cloud);
  EXPECT_EQ(read_point_cloud(folder / "a.pcd").cloud.colors, expected);
}

TEST(PcdWriter, HeaderIsWhatPclReads) {
  const TempFolder folder;
  PointCloud cloud;
  cloud.positions = {{1.0F, 2.5F, -3.0F}};
  cloud.colors = Array<Rgb8>{{255, 0, 7}};
  write_pcd(folder / "a.pcd", cloud, PcdEncoding::kAscii);
  EXPECT_EQ(read_bytes(folder / "a.pcd"),
            "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\n"
            "COUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2.5 -3 16711687\n");
  write_pcd(folder / "b.pcd", cloud);
  EXPECT_THAT(read_bytes(folder / "b.pcd"), HasSubstr("TYPE F F F F\n"));
  EXPECT_THAT(read_bytes(folder / "b.pcd"),
              EndsWith("DATA binary\n" + Bytes().put(1.0F, 2.5F, -3.0F, 0x00ff0007U).str()));
}

TEST(PcdWriter, FailsOnAFullDisk) {
  for (const PcdEncoding encoding : {PcdEncoding::kAscii, PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed}) {
    EXPECT_THROW(write_pcd("/dev/full", sample_clouds().front(), encoding), OutputError);
  }
}

}  // namespace pcd_writer_test
}  // namespace cmap::testing
