#include "recordings/messages/message_decoder.hpp"

#include <stdexcept>

#include "recordings/messages/livox_custom.hpp"
#include "recordings/messages/point_cloud2.hpp"
#include "recordings/messages/small_messages.hpp"
#include "recordings/messages/velodyne_scan.hpp"

namespace cmap {

MessageDecoder::MessageDecoder(MessageKind kind, MessageEncoding encoding, PointTimeUnit point_time_unit,
                               double acceleration_unit_mps2)
    : kind_(kind), encoding_(encoding), times_(point_time_unit), acceleration_unit_mps2_(acceleration_unit_mps2) {}

std::uint32_t MessageDecoder::sequence(std::span<const std::byte> message) const {
  return WireReader(encoding_, message).header().sequence;
}

RecordedMessage MessageDecoder::decode(std::span<const std::byte> message, std::optional<std::int64_t> stamp_ns) {
  WireReader reader(encoding_, message);
  if (stamp_ns) reader.replace_stamp(*stamp_ns);
  switch (kind_) {
    case MessageKind::kPointCloud2:
      return scan_of(read_point_cloud2(reader), times_);
    case MessageKind::kLivoxCustom:
      return read_livox_custom(reader);
    case MessageKind::kVelodyneScan:
      return read_velodyne_scan(reader);
    case MessageKind::kImu: {
      ImuSample sample = read_imu_message(reader);
      sample.specific_force_mps2 *= acceleration_unit_mps2_;
      return sample;
    }
    case MessageKind::kImage:
      return read_image_message(reader);
    case MessageKind::kCompressedImage:
      return read_compressed_image_message(reader);
    case MessageKind::kOdometry:
      return read_odometry_message(reader);
    case MessageKind::kTimeReference:
      break;
  }
  throw std::invalid_argument("MessageDecoder: a kind that is for no role");
}

}  // namespace cmap
