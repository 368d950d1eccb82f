#pragma once

#include <cstdint>

#include "cmap/io/recording.hpp"
#include "recordings/wire/wire_reader.hpp"

namespace cmap {

// Each throws InputError where a number is not finite.

/// sensor_msgs/Imu, accelerations as they are.
ImuSample read_imu_message(WireReader& reader);

/// sensor_msgs/Image. Throws where rows do not fit into the data.
RecordedImage read_image_message(WireReader& reader);
/// sensor_msgs/CompressedImage; the encoding is what the bytes begin with, as the format is free text.
RecordedImage read_compressed_image_message(WireReader& reader);

/// nav_msgs/Odometry: the pose of the child frame.
StampedPose read_odometry_message(WireReader& reader);

/// sensor_msgs/TimeReference.
struct TimeReference {
  MessageHeader header;
  std::int64_t reference_ns = 0;
};
TimeReference read_time_reference_message(WireReader& reader);

}  // namespace cmap
