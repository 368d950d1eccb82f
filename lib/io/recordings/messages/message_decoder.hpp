#pragma once

#include "recordings/messages/message_kind.hpp"
#include "recordings/messages/point_times.hpp"
#include "recordings/wire/wire_reader.hpp"

namespace cmap {

/// Understands the messages of one topic, in their order.
class MessageDecoder {
 public:
  /// Accelerations are multiplied by `acceleration_unit_mps2`.
  MessageDecoder(MessageKind kind, MessageEncoding encoding, PointTimeUnit point_time_unit,
                 double acceleration_unit_mps2);

  /// The sequence number in the header.
  std::uint32_t sequence(std::span<const std::byte> message) const;
  /// `stamp_ns`, if there is one, takes the place of the header's. Throws InputError with the byte and the reason.
  RecordedMessage decode(std::span<const std::byte> message, std::optional<std::int64_t> stamp_ns);

 private:
  MessageKind kind_;
  MessageEncoding encoding_;
  PointTimes times_;
  double acceleration_unit_mps2_;
};

}  // namespace cmap
