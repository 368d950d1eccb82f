#include "recordings/messages/point_cloud2.hpp"

#include <cmath>
#include <limits>

#include "io/io_testing.hpp"
#include "io/wire_testing.hpp"

namespace cmap::testing {
namespace point_cloud2_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

LidarScan read(Wire wire, const std::string& message, PointTimes times = PointTimes()) {
  WireReader reader(encoding_of(wire), bytes_of(message));
  return scan_of(read_point_cloud2(reader), times);
}

std::string refusal_of(const CloudText& cloud) {
  try {
    read(Wire::kRos1, point_cloud2(Wire::kRos1, cloud));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// Velodyne's points: 22 bytes.
const std::vector<FieldText> kVelodyne{{"x", 0, kPointFloat32},    {"y", 4, kPointFloat32},
                                       {"z", 8, kPointFloat32},    {"intensity", 12, kPointFloat32},
                                       {"ring", 16, kPointUint16}, {"time", 18, kPointFloat32}};

CloudText velodyne(std::initializer_list<float> times) {
  Bytes data;
  float k = 0.0F;
  for (const float time : times) {
    data.put(k, k + 0.25F, -k, 10.0F + k, static_cast<std::uint16_t>(3 + k), time);
    k += 1.0F;
  }
  const auto n = static_cast<std::uint32_t>(times.size());
  return {1, n, kVelodyne, false, 22, 22 * n, data.str()};
}

TEST(PointCloud2, VelodyneInEveryEncoding) {
  for (const Wire wire : kWires) {
    const LidarScan scan = read(wire, point_cloud2(wire, velodyne({-0.1002F, 0.0F, 0.0006F})));
    EXPECT_EQ(scan.timestamp_s, 100.5);
    EXPECT_THAT(scan.positions, ElementsAre(Eigen::Vector3f(0, 0.25F, 0), Eigen::Vector3f(1, 1.25F, -1),
                                            Eigen::Vector3f(2, 2.25F, -2)));
    EXPECT_THAT(scan.intensity, ElementsAre(10.0F, 11.0F, 12.0F));
    EXPECT_THAT(scan.ring, ElementsAre(3, 4, 5));
    EXPECT_THAT(scan.time_s, ElementsAre(-0.1002F, 0.0F, 0.0006F)) << "negative ones are normal, none are stretched";
  }
}

TEST(PointCloud2, FieldsOutOfOrderInPaddedRowsAndPointsOfBigEndian) {
  Bytes data({}, true);
  for (const double k : {1.0, 2.0, 3.0, 4.0}) {
    data.put(static_cast<float>(3 * k), static_cast<std::uint8_t>(9), k, static_cast<std::uint32_t>(1000 * k));
    data.put(static_cast<float>(2 * k), std::uint32_t{0xFFFFFFFF});
    if (k == 2.0 || k == 4.0) data.text("row's padding");
  }
  const CloudText cloud{2,
                        2,
                        {{"z", 0, kPointFloat32},
                         {"unknown", 4, 99},
                         {"x", 5, kPointFloat64},
                         {"t", 13, kPointUint32},
                         {"y", 17, kPointFloat32}},
                        true,
                        25,
                        63,
                        data.str()};
  for (const Wire wire : kWires) {
    const LidarScan scan = read(wire, point_cloud2(wire, cloud));
    EXPECT_THAT(scan.positions, ElementsAre(Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(2, 4, 6),
                                            Eigen::Vector3f(3, 6, 9), Eigen::Vector3f(4, 8, 12)));
    EXPECT_THAT(scan.time_s, ElementsAre(1e-6F, 2e-6F, 3e-6F, 4e-6F)) << "Ouster's t is in nanoseconds";
    EXPECT_TRUE(scan.intensity.empty());
    EXPECT_TRUE(scan.ring.empty());
  }
}

TEST(PointCloud2, PointsThatAreNoneGoWithTheirTimes) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  Bytes data;
  data.put(nan, 0.0F, 0.0F, 1.0F, std::uint16_t{1}, 0.01F);
  data.put(1.0F, 2.0F, 3.0F, 1.0F, std::uint16_t{2}, 0.02F);
  data.put(1.0F, infinity, 3.0F, 1.0F, std::uint16_t{3}, 1e30F);
  data.put(4.0F, 5.0F, 6.0F, 1.0F, std::uint16_t{4}, nan);
  data.put(7.0F, 8.0F, 9.0F, 2.0F, std::uint16_t{5}, 0.05F);
  const LidarScan scan = read(Wire::kRos1, point_cloud2(Wire::kRos1, {1, 5, kVelodyne, false, 22, 110, data.str()}));
  EXPECT_THAT(scan.positions, ElementsAre(Eigen::Vector3f(1, 2, 3), Eigen::Vector3f(7, 8, 9)));
  EXPECT_THAT(scan.time_s, ElementsAre(0.02F, 0.05F));
  EXPECT_THAT(scan.ring, ElementsAre(2, 5));
  EXPECT_THAT(scan.intensity, ElementsAre(1.0F, 2.0F));
}

TEST(PointCloud2, LivoxTimesOfAClockAreOffsetsAndItsNoiseIsLeftOut) {
  const std::vector<FieldText> fields{{"x", 0, kPointFloat32},         {"y", 4, kPointFloat32},
                                      {"z", 8, kPointFloat32},         {"intensity", 12, kPointFloat32},
                                      {"tag", 16, kPointUint8},        {"line", 17, kPointUint8},
                                      {"timestamp", 18, kPointFloat64}};
  Bytes data;
  const double stamp_ns = 1700000000.25e9;
  int k = 0;
  for (const int tag : {0x00, 0x10, 0x20, 0x30, 0x0F}) {
    data.put(1.0F + static_cast<float>(k), 0.0F, 0.0F, 5.0F, static_cast<std::uint8_t>(tag),
             static_cast<std::uint8_t>(k), stamp_ns + 1024.0 * 1e3 * k);
    ++k;
  }
  const LidarScan scan =
      read(Wire::kCdrLittle,
           point_cloud2(Wire::kCdrLittle, {1, 5, fields, false, 26, 130, data.str()}, 1700000000, 250'000'000));
  EXPECT_THAT(scan.ring, ElementsAre(0, 1, 4));
  EXPECT_THAT(scan.time_s, ElementsAre(0.0F, 1.024e-3F, 4.096e-3F));
}

TEST(PointCloud2, ScansWithoutPointsAndWithoutTimes) {
  EXPECT_TRUE(read(Wire::kRos1, point_cloud2(Wire::kRos1, {1, 0, kVelodyne, false, 22, 0, ""})).positions.empty());
  EXPECT_TRUE(read(Wire::kRos1, point_cloud2(Wire::kRos1, {0, 0, {}, false, 0, 0, ""})).positions.empty());
  CloudText plain = velodyne({0.0F, 0.1F});
  plain.fields = {kVelodyne[0], kVelodyne[1], kVelodyne[2]};
  plain.row_step = 0;  // as some publishers leave it
  const LidarScan scan = read(Wire::kRos1, point_cloud2(Wire::kRos1, plain));
  EXPECT_EQ(scan.positions.size(), 2U);
  EXPECT_TRUE(scan.time_s.empty());
}

TEST(PointCloud2, WhatDoesNotFitIsRefused) {
  CloudText cloud = velodyne({0.0F, 0.1F});
  cloud.width = 3;
  EXPECT_THAT(refusal_of(cloud), HasSubstr("1 x 3 points of 22 bytes in rows of 66 do not fit into 44 bytes"));
  cloud = velodyne({0.0F, 0.1F});
  cloud.height = 2;
  cloud.width = 1;
  cloud.row_step = 10;
  EXPECT_THAT(refusal_of(cloud), HasSubstr("rows of 10 bytes cannot hold 1 points of 22 bytes"));
  cloud = velodyne({0.0F, 0.1F});
  cloud.fields[5].offset = 19;
  EXPECT_THAT(refusal_of(cloud), HasSubstr("the field 'time' at byte 19 does not fit into points of 22 bytes"));
  cloud.fields[5].offset = 0xFFFFFFFE;
  EXPECT_THAT(refusal_of(cloud), HasSubstr("does not fit"));
  cloud = velodyne({0.0F, 0.1F});
  cloud.fields[1].name = "why";
  EXPECT_THAT(refusal_of(cloud), HasSubstr("no field 'y'"));
  cloud = velodyne({0.0F});
  cloud.height = cloud.width = cloud.row_step = 0xFFFFFFFF;
  EXPECT_THAT(refusal_of(cloud), HasSubstr("rows of 4294967295 bytes cannot hold 4294967295 points"));
  cloud = {1, 4, kVelodyne, false, 0, 0, ""};
  EXPECT_THAT(refusal_of(cloud), HasSubstr("4 points of 0 bytes"));
}

TEST(PointCloud2, EveryCutIsRefused) {
  for (const Wire wire : kWires) {
    const std::string message = point_cloud2(wire, velodyne({0.0F, 0.1F}));
    for (std::size_t n = 0; n + 1 < message.size(); ++n) {
      EXPECT_THROW(read(wire, message.substr(0, n)), InputError) << n;
    }
  }
}

}  // namespace point_cloud2_test
}  // namespace cmap::testing
