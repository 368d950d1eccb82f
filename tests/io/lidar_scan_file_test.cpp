#include "cmap/io/lidar_scan_file.hpp"

#include "containers/lzf_codec.hpp"
#include "io/capture_testing.hpp"

namespace cmap::testing {
namespace lidar_scan_file_test {

using ::testing::HasSubstr;

std::string header(std::string_view fields, std::string_view sizes, std::string_view types, int points,
                   std::string_view data) {
  std::string counts;
  for (const char c : types) counts += c == ' ' ? ' ' : '1';
  return fmt::format("VERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\nWIDTH {}\nHEIGHT 1\nPOINTS {}\nDATA {}\n",
                     fields, sizes, types, counts, points, points, data);
}

LidarScan read_text(std::string_view content) {
  const TempFolder folder;
  return read_lidar_scan(folder.write("scan.pcd", content), 12.5);
}

/// Fields in another order, of other types, and one that is not asked for.
void expect_three_points(const LidarScan& scan) {
  EXPECT_EQ(scan.timestamp_s, 12.5);
  EXPECT_EQ(scan.positions, (Array<Eigen::Vector3f>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9.5F}}));
  EXPECT_EQ(scan.intensity, (Array<float>{10, 20, 255}));
  EXPECT_EQ(scan.time_s, (Array<float>{0, 0.025F, 0.1F}));
  EXPECT_EQ(scan.ring, (Array<std::uint16_t>{0, 63, 127}));
}

constexpr std::string_view kFields = "ring time x y z label intensity";
constexpr std::string_view kSizes = "1 8 4 4 8 2 1", kTypes = "U F F F F I U";

TEST(LidarScan, ReadsText) {
  expect_three_points(read_text(header(kFields, kSizes, kTypes, 3, "ascii") +
                                "0 0 1 2 3 -1 10\n63 0.025 4 5 6 -1 20\n\n127 0.1 7 8 9.5 -1 255\n"));
}

TEST(LidarScan, ReadsBinary) {
  Bytes bytes(header(kFields, kSizes, kTypes, 3, "binary"));
  bytes.put(U8{0}, 0.0, 1.0F, 2.0F, 3.0, std::int16_t{-1}, U8{10});
  bytes.put(U8{63}, 0.025, 4.0F, 5.0F, 6.0, std::int16_t{-1}, U8{20});
  bytes.put(U8{127}, 0.1, 7.0F, 8.0F, 9.5, std::int16_t{-1}, U8{255});
  expect_three_points(read_text(bytes.str()));
}

TEST(LidarScan, ReadsCompressed) {
  Bytes body;
  body.put(U8{0}, U8{63}, U8{127}, 0.0, 0.025, 0.1, 1.0F, 4.0F, 7.0F, 2.0F, 5.0F, 8.0F, 3.0, 6.0, 9.5);
  body.put(std::int16_t{-1}, std::int16_t{-1}, std::int16_t{-1}, U8{10}, U8{20}, U8{255});
  const auto packed = lzf_shrink(std::as_bytes(std::span(body.str())));
  Bytes file(header(kFields, kSizes, kTypes, 3, "binary_compressed"));
  file.put(static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(body.str().size()));
  file.text({reinterpret_cast<const char*>(packed.data()), packed.size()});
  expect_three_points(read_text(file.str()));
}

TEST(LidarScan, OnlyPositionsAreNeeded) {
  const LidarScan scan = read_text(header("x y z", "4 4 4", "F F F", 1, "ascii") + "1 2 3\n");
  EXPECT_EQ(scan.positions.size(), 1U);
  EXPECT_TRUE(scan.intensity.empty() && scan.time_s.empty() && scan.ring.empty());
}

TEST(LidarScan, PointsThatAreNotFiniteAreDroppedFromEveryArray) {
  const LidarScan scan = read_text(header("x y z intensity ring", "4 4 4 4 2", "F F F F U", 4, "ascii") +
                                   "nan nan nan 0 1\n1 2 3 5 2\n1 2 inf 6 3\n1 2 3 nan 4\n");
  EXPECT_EQ(scan.positions, (Array<Eigen::Vector3f>{{1, 2, 3}}));
  EXPECT_EQ(scan.intensity, Array<float>{5});
  EXPECT_EQ(scan.ring, Array<std::uint16_t>{2});
}

TEST(LidarScan, SkyIsAnEmptyScan) {
  for (const std::string_view data : {"ascii", "binary", "binary_compressed"}) {
    EXPECT_TRUE(read_text(header("x y z", "4 4 4", "F F F", 0, data)).positions.empty());
  }
  const TempFolder folder;
  write_lidar_scan({}, folder / "empty.pcd");
  EXPECT_TRUE(read_lidar_scan(folder / "empty.pcd", 0).positions.empty());
}

TEST(LidarScan, SaysWhatIsWrong) {
  const std::string xyzt = header("x y z time", "4 4 4 8", "F F F F", 1, "ascii");
  const std::pair<std::string, std::string> kCases[] = {
      {header("x y", "4 4", "F F", 1, "ascii") + "1 2\n", "no field 'z'"},
      {header("x y z x", "4 4 4 4", "F F F F", 1, "ascii") + "1 2 3 4\n", "'x' is declared twice"},
      {xyzt + "1 2 3 1317042504.9\n", "point 1: time 1.31704e+09"},
      {xyzt + "100 200 300\n", "line 10: ends before the value of 'time'"},
      {xyzt + "1 2 3 4 5\n", "line 10: '5' follows the last value"},
      {xyzt + "1 2 c 4\n", "line 10: 'c' is not a number"},
      {header("x y z", "4 4 4", "F F F", 2, "ascii") + "1 2 3\n      \n", "truncated: 1 of 2 points"},
      {header("x y z", "4 4 4", "F F F", 1000000, "ascii") + "1 2 3\n", "truncated: 1000000 lines"},
      {header("x y z", "4 4 4", "F F F", 1000000, "binary") + "123456789012", "truncated: 1000000 points"},
      {header("x y z", "4 4 4", "F F F", 1, "binary_compressed") + "12345678", "compressed body"},
      {header("x y z ring", "4 4 4 4", "F F F F", 1, "ascii") + "1 2 3 0.5\n", "point 1: ring 0.5"},
      {header("x y z ring", "4 4 4 4", "F F F U", 1, "ascii") + "1 2 3 65536\n", "point 1: ring 65536"},
      {"VERSION 0.7\n", "before the line DATA"},
      {"", "the file is empty"},
  };
  for (const auto& [content, message] : kCases) {
    EXPECT_THAT(input_error([&] { read_text(content); }), HasSubstr(message));
    EXPECT_THAT(input_error([&] { read_text(content); }), HasSubstr("scan.pcd: "));
  }
  LidarScan scan;
  scan.positions.resize(2);
  scan.ring.resize(1);
  EXPECT_THROW(write_lidar_scan(scan, "never.pcd"), std::invalid_argument);
}

}  // namespace lidar_scan_file_test
}  // namespace cmap::testing
