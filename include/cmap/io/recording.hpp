#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/core/enum_names.hpp"
#include "cmap/core/warning.hpp"
#include "cmap/geometry/imu_sample.hpp"
#include "cmap/geometry/lidar_scan.hpp"
#include "cmap/geometry/trajectory.hpp"
#include "cmap/io/capture.hpp"

namespace cmap {

/// What a topic of a recording is for.
enum class RecordingRole { kLidar, kImu, kImage, kOdometry };
inline constexpr std::size_t kRecordingRoles = 4;
/// "lidar", "imu", "image", "odometry".
const EnumNames<RecordingRole>& recording_role_names();

/// A photograph as it was recorded.
struct RecordedImage {
  double time_s = 0.0;
  std::string encoding;        ///< "jpeg" or "png", or what raw pixels are: rgb8, bgr8, mono8, bayer_rggb8, ...
  int width = 0, height = 0;   ///< 0 where it is compressed
  std::size_t row_bytes = 0;   ///< of a row of raw pixels with its padding
  bool is_big_endian = false;  ///< of raw pixels of 16 bits
  Array<std::byte> bytes;
};

/// Every time is the stamp in the message's header (or what a time reference says in its place), not that of arrival.
/// Points of a scan come with their own times as the driver gave them, in seconds from the stamp; some drivers' are
/// negative. A scan may be without any point.
using RecordedMessage = std::variant<LidarScan, ImuSample, RecordedImage, StampedPose>;

/// A topic as its recording lists it.
struct RecordingTopic {
  std::string name;
  std::string type;      ///< "sensor_msgs/Imu", also in ROS 2
  std::string encoding;  ///< "ros1", "cdr"; messages of others are not understood
  std::uint64_t n_messages = 0;
  std::optional<RecordingRole> role;  ///< what its messages can be for; none: stepped over
};

/// The unit of points' times.
enum class PointTimeUnit { kAuto, kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };
const EnumNames<PointTimeUnit>& point_time_unit_names();

/// What accelerations are measured in; drivers of Livox give g.
enum class AccelerationUnit { kAuto, kMps2, kG };

/// Of one role.
struct RecordingSource {
  /// kIfUsable: none where the recording has no topic of the kind.
  Want want = Want::kIfUsable;
  /// Empty: the one topic of the kind, if there is but one.
  std::string topic;
  /// A topic of sensor_msgs/TimeReference: its time_ref takes the place of the header's stamp of the message with the
  /// same sequence number; messages without are left out, and counted. Empty: header stamps. ROS 1 only.
  std::string time_reference;
};

struct RecordingOptions {
  /// Odometry only if it is asked for: it is nobody's sensor.
  std::array<RecordingSource, kRecordingRoles> sources = {RecordingSource{}, {}, {}, {Want::kNo, "", ""}};
  /// kAuto: of whole numbers nanoseconds, unless the field's name says otherwise (_us); of floating-point numbers the
  /// unit that makes them times within a scan, or near the stamp if they are times of a clock.
  PointTimeUnit point_time_unit = PointTimeUnit::kAuto;
  /// kAuto: g where the mean of the first accelerations is below 3.
  AccelerationUnit acceleration_unit = AccelerationUnit::kAuto;

  RecordingSource& source(RecordingRole role) { return sources[static_cast<std::size_t>(role)]; }
  const RecordingSource& source(RecordingRole role) const { return sources[static_cast<std::size_t>(role)]; }
};

/// Whether a path is a recording, by its content: a ROS 1 bag, an MCAP file, an SQLite file with the tables of rosbag2,
/// or a folder with metadata.yaml (rosbag2).
bool is_recording(const std::filesystem::path& path);

/// The topics of a recording by name. Throws as Recording does.
std::vector<RecordingTopic> recording_topics(const std::filesystem::path& path);

/// A recording, read message by message in bounded memory.
///
/// Throws InputError naming file, place and reason: no recording; a topic that is not there, or several of the kind
/// (what there is, is listed); what is cut off, unindexed or has a wrong checksum, when the reading comes to it;
/// messages that are not what their type says. UnsupportedError: a compression or a container that this build cannot
/// read. One thread at a time.
class Recording {
 public:
  explicit Recording(const std::filesystem::path& path, const RecordingOptions& options = {});
  ~Recording();
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;

  /// All, by name.
  const std::vector<RecordingTopic>& topics() const;
  /// The topic that is read for a role; empty: none.
  const std::string& topic_of(RecordingRole role) const;
  /// Whether accelerations were in g; they are given in m/s^2 all the same.
  bool has_acceleration_in_g() const;

  /// The next message in the order of arrival times, those of the files of a split recording merged; none: the end.
  /// What stands before a place that is cut off or faulty is given before the InputError is thrown.
  std::optional<RecordedMessage> next();

  /// When the last message arrived, as recorded, and the share of all messages in their number, in [0,1].
  double arrival_time_s() const;
  double done() const;
  /// What was decided on the user's behalf so far; of messages that were left out, complete at the end.
  std::vector<Warning> warnings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A rig: the keys of capture.json and "recording", which says what is read and how (FORMATS, "Recordings").
struct RecordingConfiguration {
  CaptureCalibration calibration;
  RecordingOptions options;
  std::vector<Warning> warnings;
};

/// Throws InputError naming file, key and reason. Who needs no camera reads a rig of a LiDAR alone.
RecordingConfiguration read_recording_configuration(const std::filesystem::path& path, bool needs_camera = true);

}  // namespace cmap
