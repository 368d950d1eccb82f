#include <limits>

#include "io/io_testing.hpp"
#include "io/wire_testing.hpp"
#include "recordings/messages/livox_custom.hpp"
#include "recordings/messages/small_messages.hpp"
#include "recordings/messages/velodyne_scan.hpp"

namespace cmap::testing {
namespace recorded_messages_test {

using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;

template <class Read>
auto read(const WireWriter& writer, Read&& read_message) {
  WireReader reader(encoding_of(writer.wire()), bytes_of(writer.str()));
  return read_message(reader);
}

/// Cut anywhere, it is refused.
template <class Read>
void expect_cuts_refused(const WireWriter& writer, Read&& read_message) {
  for (std::size_t n = 0; n < writer.str().size(); ++n) {
    EXPECT_THROW(
        {
          WireReader reader(encoding_of(writer.wire()), bytes_of(writer.str()).first(n));
          read_message(reader);
        },
        InputError)
        << n;
  }
}

template <class Read>
std::string refusal_of(const WireWriter& writer, Read&& read_message) {
  try {
    read(writer, read_message);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

WireWriter livox(Wire wire, std::uint64_t timebase_ns, std::uint32_t declared,
                 std::initializer_list<std::uint8_t> tags) {
  WireWriter writer(wire);
  writer.header(1, 50, 250'000'000).put(timebase_ns).put(declared).zeros<std::uint8_t>(4);
  writer.put(static_cast<std::uint32_t>(tags.size()));
  std::uint32_t k = 0;
  for (const std::uint8_t tag : tags) {
    writer.put(1'000'000 * k).put(static_cast<float>(k)).put(0.5F).put(-1.0F);
    writer.put(static_cast<std::uint8_t>(100 + k)).put(tag).put(static_cast<std::uint8_t>(k));
    ++k;
  }
  return writer;
}

TEST(LivoxCustom, PointsByTagWithTheirTimesFromTheStamp) {
  for (const Wire wire : kWires) {
    const LidarScan scan = read(livox(wire, 50'250'000'000, 4, {0x00, 0x20, 0x10, 0x30}), read_livox_custom);
    EXPECT_EQ(scan.timestamp_s, 50.25);
    EXPECT_THAT(scan.positions, ElementsAre(Eigen::Vector3f(0, 0.5F, -1), Eigen::Vector3f(2, 0.5F, -1)));
    EXPECT_THAT(scan.intensity, ElementsAre(100.0F, 102.0F));
    EXPECT_THAT(scan.ring, ElementsAre(0, 2));
    EXPECT_THAT(scan.time_s, ElementsAre(FloatEq(0.0F), FloatEq(0.002F)));
  }
}

TEST(LivoxCustom, ATimebaseBesideTheStampShiftsTimesAndOneOfAnotherClockDoesNot) {
  EXPECT_THAT(read(livox(Wire::kRos1, 50'240'000'000, 1, {0}), read_livox_custom).time_s, ElementsAre(FloatEq(-0.01F)));
  EXPECT_THAT(read(livox(Wire::kRos1, 3'000'000'000, 1, {0}), read_livox_custom).time_s, ElementsAre(FloatEq(0.0F)));
  EXPECT_THAT(read(livox(Wire::kRos1, 0xFFFFFFFFFFFFFFFF, 1, {0}), read_livox_custom).time_s,
              ElementsAre(FloatEq(0.0F)));
}

TEST(LivoxCustom, WhatIsWrongIsNamed) {
  EXPECT_THAT(refusal_of(livox(Wire::kRos1, 0, 5, {0, 0}), read_livox_custom),
              HasSubstr("2 points, but point_num is 5"));
  EXPECT_TRUE(read(livox(Wire::kCdrLittle, 0, 0, {}), read_livox_custom).positions.empty());
  for (const Wire wire : kWires) expect_cuts_refused(livox(wire, 0, 2, {0, 0}), read_livox_custom);
}

WireWriter imu(Wire wire, double last) {
  WireWriter writer(wire);
  writer.raw(imu_message(wire, 1.0, 2.0, last).substr(writer.str().size()));
  return writer;
}

TEST(RecordedMessages, Imu) {
  for (const Wire wire : kWires) {
    const ImuSample sample = read(imu(wire, 3.0), read_imu_message);
    EXPECT_EQ(sample.time_s, 100.0);
    EXPECT_EQ(sample.angular_rate_radps, Eigen::Vector3d(0.1, 0.2, 0.3));
    EXPECT_EQ(sample.specific_force_mps2, Eigen::Vector3d(1.0, 2.0, 3.0));
    expect_cuts_refused(imu(wire, 3.0), read_imu_message);
  }
  EXPECT_THAT(refusal_of(imu(Wire::kRos1, std::numeric_limits<double>::quiet_NaN()), read_imu_message),
              HasSubstr("an acceleration is nan"));
}

WireWriter image(Wire wire, std::uint32_t height, std::uint32_t width, std::uint32_t step, std::string_view data) {
  WireWriter writer(wire);
  writer.header(3, 9, 5).put(height).put(width).text("bgr8").put(std::uint8_t{0}).put(step).blob(data);
  return writer;
}

TEST(RecordedMessages, Image) {
  for (const Wire wire : kWires) {
    const RecordedImage found = read(image(wire, 2, 1, 4, "abc.def."), read_image_message);
    EXPECT_EQ(found.time_s, 9.0 + 5e-9);
    EXPECT_EQ(found.encoding, "bgr8");
    EXPECT_EQ(found.width, 1);
    EXPECT_EQ(found.height, 2);
    EXPECT_EQ(found.row_bytes, 4U);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(found.bytes.data()), found.bytes.size()), "abc.def.");
  }
  EXPECT_THAT(refusal_of(image(Wire::kRos1, 3, 1, 4, "abc.def."), read_image_message), HasSubstr("3 rows of 4 bytes"));
  EXPECT_THAT(refusal_of(image(Wire::kRos1, 1, 9, 4, "abc.def."), read_image_message), HasSubstr("9 pixels"));
  EXPECT_THAT(refusal_of(image(Wire::kRos1, 0, 9, 4, ""), read_image_message), HasSubstr("9 x 0 pixels"));
}

TEST(RecordedMessages, CompressedImageIsWhatItsBytesSay) {
  for (const Wire wire : kWires) {
    const auto with = [&](std::string_view data) {
      WireWriter writer(wire);
      writer.header(3, 9, 5).text("bgr8; jpeg compressed bgr8").blob(data);
      return writer;
    };
    EXPECT_EQ(read(with("\xFF\xD8\xFF\xE0..."), read_compressed_image_message).encoding, "jpeg");
    EXPECT_EQ(read(with("\x89PNG\r\n"), read_compressed_image_message).encoding, "png");
    EXPECT_THAT(refusal_of(with(""), read_compressed_image_message), HasSubstr("neither JPEG nor PNG"));
  }
}

WireWriter odometry(Wire wire, double w) {
  WireWriter writer(wire);
  writer.header(3, 9, 5).text("base").put(1.0).put(2.0).put(3.0).put(0.0).put(0.0).put(0.0).put(w).zeros<double>(
      36 + 6 + 36);
  return writer;
}

TEST(RecordedMessages, Odometry) {
  for (const Wire wire : kWires) {
    const StampedPose pose = read(odometry(wire, -1.0), read_odometry_message);
    EXPECT_EQ(pose.position, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(pose.rotation.coeffs(), Eigen::Vector4d(0, 0, 0, -1));
    expect_cuts_refused(odometry(wire, 1.0), read_odometry_message);
  }
  EXPECT_THAT(refusal_of(odometry(Wire::kRos1, 0.0), read_odometry_message), HasSubstr("quaternion has length 0"));
}

TEST(RecordedMessages, TimeReference) {
  WireWriter writer(Wire::kRos1);
  writer.header(3, 9, 5).put(std::uint32_t{8}).put(std::uint32_t{7}).text("gps");
  const TimeReference reference = read(writer, read_time_reference_message);
  EXPECT_EQ(reference.header.sequence, 3U);
  EXPECT_EQ(reference.reference_ns, 8'000'000'007);
}

TEST(RecordedMessages, OnlyPlainCdrIsUnderstood) {
  const std::string parameters("\0\3\0\0", 4);
  EXPECT_THROW(WireReader(MessageEncoding::kCdr, bytes_of(parameters)), InputError);
  EXPECT_THROW(WireReader(MessageEncoding::kCdr, bytes_of("\0\1")), InputError);
}

/// A packet whose every shot is 2 m away; azimuths from `begin` on by 40 hundredths of a degree a block.
std::string velodyne_packet(int begin_cdeg, std::uint8_t mode, std::uint8_t product) {
  Bytes packet;
  for (int block = 0; block < 12; ++block) {
    packet.put(std::uint16_t{0xEEFF}, static_cast<std::uint16_t>((begin_cdeg + 40 * block) % 36000));
    for (int shot = 0; shot < 32; ++shot) packet.put(std::uint16_t{1000}, static_cast<std::uint8_t>(shot));
  }
  return packet.put(std::uint32_t{0}, mode, product).str();
}

WireWriter velodyne_scan(Wire wire, const std::string& packet) {
  WireWriter writer(wire);
  writer.header(0, 20, 0).put(std::uint32_t{1}).put(std::uint32_t{20}).put(std::uint32_t{1'000'000}).raw(packet);
  return writer;
}

TEST(VelodyneScan, ShotsOfAPacketWithTheirTimes) {
  for (const Wire wire : kWires) {
    const LidarScan scan = read(velodyne_scan(wire, velodyne_packet(35900, 0x37, 0x22)), read_velodyne_scan);
    ASSERT_EQ(scan.positions.size(), 12U * 32U);
    // Laser 1 looks 1 degree up; the head has turned 2.304 / 110.592 of the way to the next block, across 360 degrees.
    const double azimuth = (359.0 + 0.4 * 2.304 / 110.592) * M_PI / 180.0, elevation = M_PI / 180.0;
    EXPECT_LT(
        (scan.positions[1] - Eigen::Vector3d(2 * std::cos(elevation) * std::cos(azimuth),
                                             -2 * std::cos(elevation) * std::sin(azimuth), 2 * std::sin(elevation))
                                 .cast<float>())
            .norm(),
        1e-6F);
    EXPECT_EQ(scan.ring[0], 0);
    EXPECT_EQ(scan.ring[1], 8);
    EXPECT_EQ(scan.intensity[33], 1.0F);
    EXPECT_NEAR(scan.time_s[1], 1e-3 + 2.304e-6, 1e-9);
    EXPECT_NEAR(scan.time_s[32 + 17], 1e-3 + 3 * 55.296e-6 + 2.304e-6, 1e-9);
  }
}

TEST(VelodyneScan, EqualReturnsOfADualOneAreOne) {
  const LidarScan scan = read(velodyne_scan(Wire::kRos1, velodyne_packet(0, 0x39, 0x22)), read_velodyne_scan);
  EXPECT_EQ(scan.positions.size(), 6U * 32U);
  EXPECT_NEAR(scan.time_s[32], 1e-3 + 2 * 55.296e-6, 1e-9);
}

TEST(VelodyneScan, OtherSensorsAndWhatIsNoPacketAreNamed) {
  EXPECT_THAT(refusal_of(velodyne_scan(Wire::kRos1, velodyne_packet(0, 0x37, 0x28)), read_velodyne_scan),
              HasSubstr("sensor 0x28"));
  std::string broken = velodyne_packet(0, 0x37, 0x22);
  broken[100] = 'x';
  EXPECT_THAT(refusal_of(velodyne_scan(Wire::kRos1, broken), read_velodyne_scan), HasSubstr("without its flag"));
}

}  // namespace recorded_messages_test
}  // namespace cmap::testing
