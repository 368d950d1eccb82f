#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "cmap/io/recording.hpp"
#include "io/real_data.hpp"
#include "recordings/containers/message_store.hpp"

namespace cmap::testing {
namespace real_recordings_test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Recordings of other projects (shared/data/formats_bags).
class RealRecordings : public RealData {
 protected:
  void SetUp() override {
    RealData::SetUp();
    if (IsSkipped()) return;
    bags_ = folder_ / "formats_bags";
    if (!fs::is_directory(bags_)) GTEST_SKIP() << "no formats_bags in " << folder_;
  }
  /// What this build lacks a library for is no failure.
  std::unique_ptr<MessageStore> open(std::string_view name) const {
    try {
      return open_message_store(bags_ / name);
    } catch (const UnsupportedError&) {
      return nullptr;
    }
  }
  fs::path bags_;
};

struct Message {
  std::string topic;
  std::int64_t log_time_ns;
  std::string data;
  bool operator==(const Message&) const = default;
};

std::vector<Message> all_of(MessageStore& store) {
  std::vector<Message> messages;
  StoredMessage message;
  while (store.next(message)) {
    messages.push_back({store.topics()[message.topic].name, message.log_time_ns,
                        std::string(reinterpret_cast<const char*>(message.data.data()), message.data.size())});
  }
  return messages;
}

/// The messages that a conformance file's JSON lists, by log time.
std::vector<Message> expected_of(const fs::path& json) {
  std::vector<Message> messages;
  std::ifstream stream(json);
  const nlohmann::json parsed = nlohmann::json::parse(stream);
  for (const auto& record : parsed.at("records")) {
    if (record.at("type") != "Message") continue;
    std::map<std::string, nlohmann::json> fields;
    for (const auto& field : record.at("fields")) fields[field.at(0)] = field.at(1);
    Message message{"example", std::stoll(fields["log_time"].get<std::string>()), ""};
    for (const auto& byte : fields["data"]) message.data += static_cast<char>(std::stoi(byte.get<std::string>()));
    messages.push_back(message);
  }
  std::ranges::stable_sort(messages, {}, &Message::log_time_ns);
  return messages;
}

TEST_F(RealRecordings, AllConformanceFilesOfMcapAreReadAsTheirJsonSays) {
  std::size_t n = 0;
  for (const auto& entry : fs::recursive_directory_iterator(bags_ / "mcap_conformance")) {
    if (entry.path().extension() != ".mcap") continue;
    SCOPED_TRACE(entry.path());
    const std::vector<Message> expected = expected_of(fs::path(entry.path()).replace_extension(".json"));
    ASSERT_FALSE(expected.empty());
    const auto store = open_message_store(entry.path());
    ASSERT_EQ(store->topics().size(), 1U);
    EXPECT_EQ(store->topics()[0].type, "Example");
    EXPECT_EQ(store->topics()[0].encoding_name, "a");
    EXPECT_EQ(store->topics()[0].n_messages, expected.size());
    EXPECT_EQ(all_of(*store), expected);
    ++n;
  }
  EXPECT_EQ(n, 308U);
}

TEST_F(RealRecordings, BagsOfRos1InThreeCompressionsHoldTheSame) {
  const auto plain = open("ros1/example.bag");
  if (!plain) GTEST_SKIP() << "built without librosbag-storage";
  const std::vector<Message> expected = all_of(*plain);
  EXPECT_EQ(expected.size(), 8647U);
  EXPECT_EQ(all_of(*open("ros1/example-bz2.bag")), expected);
  EXPECT_EQ(all_of(*open("ros1/example-lz4.bag")), expected);
  std::uint64_t listed = 0;
  for (const StoredTopic& topic : plain->topics()) listed += topic.n_messages;
  EXPECT_EQ(listed, 8647U);
  EXPECT_EQ(all_of(*open("ros1/tf_example.bag")).size(), 518U);
}

TEST_F(RealRecordings, ChunksOfABagThatAreOutOfOrderComeByTime) {
  const auto store = open("ros1/example-unsorted-chunks.bag");
  if (!store) GTEST_SKIP() << "built without librosbag-storage";
  const std::vector<Message> messages = all_of(*store);
  EXPECT_EQ(messages.size(), 3U);
  EXPECT_TRUE(std::ranges::is_sorted(messages, {}, &Message::log_time_ns));
}

TEST_F(RealRecordings, ABagThatIsCutOffIsNamed) {
  const auto plain = open("ros1/example.bag");
  if (!plain) GTEST_SKIP() << "built without librosbag-storage";
  const std::string bag = read_bytes(bags_ / "ros1/example.bag");
  const TempFolder folder;
  for (const std::size_t n : {std::size_t{14}, std::size_t{100}, std::size_t{5000}, bag.size() / 2, bag.size() - 1}) {
    const fs::path path = folder.write("cut.bag", std::string_view(bag).substr(0, n));
    try {
      all_of(*open_message_store(path));
      ADD_FAILURE() << n << " bytes are read";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("cut.bag")) << n;
    }
  }
}

TEST_F(RealRecordings, TheSameMessagesInSqliteAndMcap) {
  const auto sqlite = open("ros2/test_bag_sqlite3"), mcap = open("ros2/test_bag_mcap");
  if (!sqlite || !mcap) GTEST_SKIP() << "built without SQLite or zstd";
  EXPECT_EQ(sqlite->topics().size(), 94U);
  const std::vector<Message> of_sqlite = all_of(*sqlite), of_mcap = all_of(*mcap);
  EXPECT_EQ(of_sqlite.size(), 188U);
  EXPECT_EQ(of_mcap.size(), 188U);
  std::map<std::string, std::vector<std::string>> sqlite_data, mcap_data;
  for (const Message& message : of_sqlite) sqlite_data[message.topic].push_back(message.data);
  for (const Message& message : of_mcap) mcap_data[message.topic].push_back(message.data);
  EXPECT_EQ(sqlite_data.size(), mcap_data.size());
}

TEST_F(RealRecordings, MessagesOfEveryKindAreUnderstoodInBoth) {
  for (const std::string_view name : {"ros2/test_bag_sqlite3", "ros2/test_bag_mcap"}) {
    if (!open(name)) continue;
    RecordingOptions options;
    options.source(RecordingRole::kLidar) = {Want::kYes, "/test/sensor_msgs/point_cloud2", ""};
    options.source(RecordingRole::kImu) = {Want::kYes, "/test/sensor_msgs/imu", ""};
    options.source(RecordingRole::kImage).want = Want::kNo;
    options.source(RecordingRole::kOdometry) = {Want::kYes, "/test/nav_msgs/odometry", ""};
    Recording recording(bags_ / name, options);
    std::array<int, 4> n{};
    while (const std::optional<RecordedMessage> message = recording.next()) ++n[message->index()];
    // The image's 30 bytes are no 640 x 480 pixels.
    EXPECT_EQ(n, (std::array{2, 2, 0, 2})) << name;
  }
}

TEST_F(RealRecordings, ATurtlebotsOdometryAndACamerasImages) {
  if (!open("ros2/nav2_turtlebot.mcap")) GTEST_SKIP() << "built without zstd";
  RecordingOptions options;
  options.source(RecordingRole::kOdometry).want = Want::kYes;
  Recording turtlebot(bags_ / "ros2/nav2_turtlebot.mcap", options);
  std::size_t n = 0;
  double last_s = 0.0;
  while (const std::optional<RecordedMessage> message = turtlebot.next()) {
    if (const auto* pose = std::get_if<StampedPose>(&*message)) {
      EXPECT_GT(pose->time_s, last_s);
      last_s = pose->time_s;
      ++n;
    }
  }
  EXPECT_GT(n, 1000U);
  std::size_t messages = 0;
  for (const RecordingTopic& topic : turtlebot.topics()) messages += topic.n_messages;
  EXPECT_EQ(messages, 8197U);
  RecordingOptions images;
  images.source(RecordingRole::kImage).want = Want::kYes;
  for (const RecordingTopic& topic : recording_topics(bags_ / "ros2/soccer_goal_12.mcap")) {
    if (topic.role == RecordingRole::kImage) images.source(RecordingRole::kImage).topic = topic.name;
  }
  Recording soccer(bags_ / "ros2/soccer_goal_12.mcap", images);
  const std::optional<RecordedMessage> image = soccer.next();
  ASSERT_TRUE(image && std::holds_alternative<RecordedImage>(*image));
  EXPECT_GT(std::get<RecordedImage>(*image).bytes.size(), 1000U) << "each message is packed by zstd";
}

/// A point of a decoded turn as Nebula's PCD has it.
struct Shot {
  Eigen::Vector3f position;
  std::uint16_t channel;
};

std::vector<Shot> nebula_turn(const fs::path& pcd) {
  const std::string bytes = read_bytes(pcd), mark = "DATA binary\n";
  constexpr std::size_t kPointBytes = 32;
  std::vector<Shot> shots;
  for (std::size_t place = bytes.find(mark) + mark.size(); place + kPointBytes <= bytes.size(); place += kPointBytes) {
    Shot shot{};
    std::memcpy(shot.position.data(), &bytes[place], 12);
    std::memcpy(&shot.channel, &bytes[place + 14], 2);
    shots.push_back(shot);
  }
  return shots;
}

/// By laser and distance, in steps of the sensor's 2 mm.
std::pair<int, long> shot_key(int ring, const Eigen::Vector3f& position) {
  return {ring, std::lround(position.cast<double>().norm() / 0.002)};
}

/// Degrees clockwise from a to b.
double turned_deg(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const double turn = std::atan2(a.y(), a.x()) - std::atan2(b.y(), b.x());
  return std::remainder(turn, 2.0 * M_PI) * 180.0 / M_PI;
}

TEST_F(RealRecordings, PacketsOfAVlp16AreTheTurnThatNebulaDecoded) {
  if (!open("nebula_vlp16")) GTEST_SKIP() << "built without SQLite";
  Recording recording(bags_ / "nebula_vlp16");
  std::vector<LidarScan> scans;
  while (std::optional<RecordedMessage> message = recording.next())
    scans.push_back(std::get<LidarScan>(std::move(*message)));
  ASSERT_EQ(scans.size(), 4U);
  // Nebula's turn begins at azimuth 0, in the last packets of the message before.
  std::map<std::pair<int, long>, std::vector<Eigen::Vector3f>> ours;
  for (std::size_t k = 2; k < 4; ++k) {
    for (std::size_t i = 0; i < scans[k].positions.size(); ++i) {
      ours[shot_key(scans[k].ring[i], scans[k].positions[i])].push_back(scans[k].positions[i]);
    }
  }
  const std::vector<Shot> turn = nebula_turn(bags_ / "nebula_vlp16/1673400472138016708.pcd");
  ASSERT_EQ(turn.size(), 14831U);
  std::size_t n_same = 0;
  for (const Shot& shot : turn) {
    double least_deg = 360.0;
    for (const Eigen::Vector3f& position : ours[shot_key(shot.channel, shot.position)]) {
      const double deg = turned_deg(shot.position, position);
      if (std::abs(deg) < std::abs(least_deg)) least_deg = deg;
    }
    if (std::abs(least_deg) < 0.0101) ++n_same;  // Nebula rounds azimuths to hundredths of a degree
    // It does not turn on within the last pair of blocks of a packet of dual returns, a sixth of the points.
    EXPECT_LT(std::abs(least_deg), 0.42);
  }
  EXPECT_GT(n_same, turn.size() * 82 / 100);
  EXPECT_NEAR(scans[0].time_s.back(), 0.0995 + 0.0006, 3e-4);
}

}  // namespace real_recordings_test
}  // namespace cmap::testing
