#include "cmap/io/recording.hpp"

#include "io/mcap_testing.hpp"

namespace cmap::testing {
namespace recording_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view kImu = "sensor_msgs/Imu", kCloud = "sensor_msgs/msg/PointCloud2";

std::string cloud(std::uint32_t width) {
  std::string data;
  for (std::uint32_t i = 0; i < width; ++i) data += Bytes().put(1.0F, 2.0F, 3.0F).str();
  return point_cloud2(Wire::kCdrLittle, {1,
                                         width,
                                         {{"x", 0, kPointFloat32}, {"y", 4, kPointFloat32}, {"z", 8, kPointFloat32}},
                                         false,
                                         12,
                                         12 * width,
                                         data});
}

McapText start() {
  return McapText().header().schema(1, kImu).schema(2, kCloud).channel(1, 1, "/imu").channel(2, 2, "/points", "cdr");
}

std::vector<std::string> all_of(Recording& recording) {
  std::vector<std::string> found;
  try {
    while (const std::optional<RecordedMessage> message = recording.next()) {
      if (const auto* scan = std::get_if<LidarScan>(&*message)) {
        found.push_back(fmt::format("scan at {} of {}", scan->timestamp_s, scan->positions.size()));
      } else if (const auto* sample = std::get_if<ImuSample>(&*message)) {
        found.push_back(fmt::format("imu at {} of {:.5f}", sample->time_s, sample->specific_force_mps2.z()));
      } else {
        found.emplace_back("other");
      }
    }
  } catch (const Error& error) {
    found.emplace_back(error.what());
  }
  return found;
}

class RecordingTest : public ::testing::Test {
 protected:
  std::vector<std::string> read(const McapText& text, const RecordingOptions& options = {}) {
    try {
      Recording recording(folder_.write("drive.mcap", text.file()), options);
      return all_of(recording);
    } catch (const Error& error) {
      return {error.what()};
    }
  }
  TempFolder folder_;
};

TEST_F(RecordingTest, MessagesByArrivalWithTheStampsOfTheirHeaders) {
  McapText text = start();
  text.message(2, 300'000'000'000, cloud(2))
      .message(1, 200'000'000'000, imu_message(Wire::kRos1, 0, 0, 9.8, 0, 107))
      .end();
  EXPECT_THAT(read(text), ElementsAre("imu at 107 of 9.80000", "scan at 100.5 of 2"));
  Recording recording(folder_ / "drive.mcap");
  EXPECT_EQ(recording.done(), 0.0);
  recording.next();
  EXPECT_EQ(recording.done(), 0.5);
  EXPECT_EQ(recording.arrival_time_s(), 200.0);
  EXPECT_EQ(recording.topic_of(RecordingRole::kImu), "/imu");
  EXPECT_EQ(recording.topic_of(RecordingRole::kImage), "");
  ASSERT_EQ(recording.topics().size(), 2U);
  EXPECT_EQ(recording.topics()[1].type, "sensor_msgs/PointCloud2");
  EXPECT_EQ(recording.topics()[1].role, RecordingRole::kLidar);
}

TEST_F(RecordingTest, AccelerationsInGAreSeenByTheirLength) {
  const McapText in_g = start()
                            .message(1, 0, imu_message(Wire::kRos1, 0.1, 0, 1.0))
                            .message(1, 1, imu_message(Wire::kRos1, 0, 0, 2.0))
                            .end();
  EXPECT_THAT(read(in_g), ElementsAre("imu at 100 of 9.80665", "imu at 100 of 19.61330"));
  EXPECT_TRUE(Recording(folder_ / "drive.mcap").has_acceleration_in_g());
  RecordingOptions options;
  options.acceleration_unit = AccelerationUnit::kMps2;
  EXPECT_THAT(read(in_g, options), ElementsAre("imu at 100 of 1.00000", "imu at 100 of 2.00000"));
}

TEST_F(RecordingTest, ATopicThatIsNotThereIsAnErrorThatListsWhatIs) {
  const McapText text = start().message(1, 5, imu_message(Wire::kRos1, 0, 0, 9.8)).end();
  RecordingOptions options;
  EXPECT_EQ(options.source(RecordingRole::kOdometry).want, Want::kNo) << "nobody's sensor";
  options.source(RecordingRole::kLidar).topic = "/livox/lidar";
  EXPECT_THAT(read(text, options),
              ElementsAre(HasSubstr("drive.mcap: no topic /livox/lidar; there is /imu (sensor_msgs/Imu, 1 messages), "
                                    "/points (sensor_msgs/PointCloud2, 0 messages)")));
  options.source(RecordingRole::kLidar).topic = "/imu";
  EXPECT_THAT(read(text, options),
              ElementsAre(HasSubstr("topic /imu holds sensor_msgs/Imu (ros1), which cannot be read as lidar")));
  options.source(RecordingRole::kLidar) = {Want::kYes, "", ""};
  EXPECT_THAT(read(text, options), ElementsAre(HasSubstr("no topic for the lidar; there is /imu")));
  EXPECT_THAT(read(text), ElementsAre("imu at 100 of 9.80000"));
}

TEST_F(RecordingTest, OfSeveralTopicsOfAKindOneMustBeNamed) {
  McapText text = start().channel(3, 1, "/imu2");
  text.message(1, 5, imu_message(Wire::kRos1, 0, 0, 9.8)).message(3, 6, imu_message(Wire::kRos1, 0, 0, 9.7)).end();
  EXPECT_THAT(read(text),
              ElementsAre(HasSubstr(
                  "which topic is the imu's (recording.topics)? There is /imu (sensor_msgs/Imu, 1 messages), /imu2")));
  RecordingOptions options;
  options.source(RecordingRole::kImu).topic = "/imu2";
  EXPECT_THAT(read(text, options), ElementsAre("imu at 100 of 9.70000"));
  options.source(RecordingRole::kImu) = {Want::kNo, "", ""};
  EXPECT_THAT(read(text, options), ElementsAre());
}

TEST_F(RecordingTest, MessagesOfOtherEncodingsAreSteppedOver) {
  const McapText text = start().channel(3, 1, "/imu2", "protobuf").message(3, 5, "?").end();
  EXPECT_THAT(read(text), ElementsAre());
  RecordingOptions options;
  options.source(RecordingRole::kImu) = {Want::kYes, "", ""};
  EXPECT_THAT(read(text, options), ElementsAre(HasSubstr("/imu2 (sensor_msgs/Imu as protobuf, 1 messages)")));
}

TEST_F(RecordingTest, AMalformedMessageIsNamedWithItsPlace) {
  EXPECT_THAT(read(start().message(1, 5, "short").end()),
              ElementsAre(HasSubstr("topic /imu (sensor_msgs/Imu): byte 4: cut off: 4 bytes expected, 1 are left")));
}

TEST_F(RecordingTest, ScansWithoutPointsAreScans) {
  EXPECT_THAT(read(start().message(2, 5, cloud(0)).end()), ElementsAre("scan at 100.5 of 0"));
}

TEST_F(RecordingTest, TimeReferencesTakeThePlaceOfStamps) {
  const auto reference = [](std::uint32_t sequence, std::uint32_t seconds) {
    return WireWriter(Wire::kRos1).header(sequence, 1, 0).put(seconds).put(std::uint32_t{0}).text("").str();
  };
  McapText text = start().schema(3, "sensor_msgs/TimeReference").channel(3, 3, "/imu/time_ref");
  for (const std::uint32_t sequence : {1U, 2U, 3U})
    text.message(1, sequence, imu_message(Wire::kRos1, 0, 0, 9.8, sequence));
  text.message(3, 9, reference(1, 51)).message(3, 10, reference(3, 53)).end();
  RecordingOptions options;
  options.source(RecordingRole::kImu).time_reference = "/imu/time_ref";
  EXPECT_THAT(read(text, options), ElementsAre("imu at 51 of 9.80000", "imu at 53 of 9.80000"));
  Recording recording(folder_ / "drive.mcap", options);
  all_of(recording);
  ASSERT_EQ(recording.warnings().size(), 1U);
  EXPECT_THAT(recording.warnings()[0].message, HasSubstr("1 messages of /imu have no time reference"));
  options.source(RecordingRole::kImu).time_reference = "/points";
  EXPECT_THAT(read(text, options), ElementsAre(HasSubstr("topic /points holds sensor_msgs/PointCloud2")));
}

TEST_F(RecordingTest, WhatIsARecordingByContent) {
  const auto is = [&](std::string_view content) { return is_recording(folder_.write("file", content)); };
  EXPECT_TRUE(is(start().end().file()));
  EXPECT_TRUE(is("#ROSBAG V2.0\n"));
  EXPECT_FALSE(is("ply\nformat ascii 1.0\n"));
  EXPECT_FALSE(is(""));
  EXPECT_FALSE(is_recording(folder_.path()));
  EXPECT_FALSE(is_recording(folder_ / "missing"));
  EXPECT_TRUE(is(std::string("SQLite format 3\0", 16) + "CREATE TABLE messages(id"));
  EXPECT_FALSE(is(std::string("SQLite format 3\0", 16) + "CREATE TABLE phones(id"));
  folder_.write("metadata.yaml", "rosbag2_bagfile_information:\n");
  EXPECT_TRUE(is_recording(folder_.path()));
}

std::string refusal_of(const std::filesystem::path& path) {
  try {
    Recording recording(path);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST_F(RecordingTest, WhatIsNoneIsNamed) {
  EXPECT_THAT(refusal_of(folder_.write("a.bag", "PK.....")), HasSubstr("a.bag: is no recording"));
  EXPECT_THAT(refusal_of(folder_.write("a.bag", "#ROSBAG V1.2\n")), HasSubstr("older than version 2.0"));
  EXPECT_THAT(refusal_of(folder_.write("a.db3.zstd", "\x28\xB5\x2F\xFD..")), HasSubstr("packed by zstd"));
  EXPECT_THAT(refusal_of(folder_.path()), HasSubstr("without metadata.yaml"));
  EXPECT_THAT(refusal_of(folder_ / "missing"), HasSubstr("no such file"));
}

/// The beginning of a bag of ROS 1 whose recording did not end: no index.
std::string unindexed_bag() {
  Bytes fields;
  const auto field = [&](std::string_view name, std::string_view value) {
    fields.put(static_cast<std::uint32_t>(name.size() + 1 + value.size())).text(name).text("=").text(value);
  };
  field("op", "\x03");
  field("index_pos", std::string(8, '\0'));
  field("conn_count", std::string(4, '\0'));
  field("chunk_count", std::string(4, '\0'));
  const auto size = static_cast<std::uint32_t>(fields.str().size());
  const std::uint32_t padding = 4096 - 13 - 8 - size;
  Bytes bag("#ROSBAG V2.0\n");
  bag.put(size).text(fields.str()).put(padding).text(std::string(padding, ' '));
  return bag.text("what was recorded").str();
}

TEST_F(RecordingTest, ABagWithoutIndexIsNamed) {
  const std::string said = refusal_of(folder_.write("a.bag", unindexed_bag()));
  EXPECT_THAT(said,
              ::testing::AnyOf(HasSubstr("a.bag: the bag is not indexed"), HasSubstr("this build of cmap cannot")));
}

TEST_F(RecordingTest, TheFilesOfARecordingAreMergedByTime) {
  folder_.write("a.mcap", start()
                              .message(1, 5, imu_message(Wire::kRos1, 0, 0, 5))
                              .message(1, 9, imu_message(Wire::kRos1, 0, 0, 9))
                              .end()
                              .file());
  folder_.write("b.mcap", start()
                              .message(1, 7, imu_message(Wire::kRos1, 0, 0, 7))
                              .message(1, 9, imu_message(Wire::kRos1, 0, 0, 10))
                              .end()
                              .file());
  for (const std::string_view list :
       {"relative_file_paths:\n    - a.mcap\n    - 'b.mcap'\n", "relative_file_paths: [a.mcap, \"b.mcap\"]\n"}) {
    folder_.write("metadata.yaml",
                  "rosbag2_bagfile_information:\n  version: 8\n  " + std::string(list) + "  compression_mode: ''\n");
    Recording recording(folder_.path());
    EXPECT_EQ(recording.topics()[0].n_messages, 4U);
    EXPECT_THAT(all_of(recording), ElementsAre("imu at 100 of 5.00000", "imu at 100 of 7.00000",
                                               "imu at 100 of 9.00000", "imu at 100 of 10.00000"));
  }
}

TEST_F(RecordingTest, WhatMetadataSaysAndIsNotReadIsNamed) {
  folder_.write("a.mcap", start().end().file());
  const std::string list = "relative_file_paths:\n  - a.mcap\n";
  const auto refusal_with = [&](const std::string& text) {
    folder_.write("metadata.yaml", text);
    return refusal_of(folder_.path());
  };
  EXPECT_THAT(refusal_with(list + "compression_format: zstd\ncompression_mode: FILE\n"),
              HasSubstr("files packed by zstd as a whole"));
  EXPECT_THAT(refusal_with("relative_file_paths:\n  - gone.db3\n"), HasSubstr("lists gone.db3, which is not there"));
  EXPECT_THAT(refusal_with("relative_file_paths: []\n"), HasSubstr("lists no file"));
  EXPECT_EQ(refusal_with(list + "compression_format: \"\"\ncompression_mode: NONE\n"), "");
}

}  // namespace recording_test
}  // namespace cmap::testing
