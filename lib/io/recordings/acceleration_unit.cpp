#include "recordings/acceleration_unit.hpp"

#include "recordings/containers/unpack_zstd.hpp"
#include "recordings/messages/small_messages.hpp"

namespace cmap {

bool has_acceleration_in_g(const std::filesystem::path& recording, std::size_t topic) {
  constexpr int kSamples = 200;
  constexpr double kBetween = 3.0;
  const std::unique_ptr<MessageStore> store = open_message_store(recording);
  const MessageEncoding encoding = store->topics().at(topic).encoding();
  std::vector<bool> is_wanted(store->topics().size(), false);
  is_wanted[topic] = true;
  store->select(is_wanted);
  double sum = 0.0;
  int n = 0;
  StoredMessage message;
  Array<std::byte> room;
  try {
    for (; n < kSamples && store->next(message); ++n) {
      WireReader reader(encoding, encoding == MessageEncoding::kCdr ? sent_message(message.data, room) : message.data);
      sum += read_imu_message(reader).specific_force_mps2.norm();
    }
  } catch (const Interrupted&) {
    throw;
  } catch (const Error&) {
    // It is an error where its message is due.
  }
  return n > 0 && sum / n < kBetween;
}

}  // namespace cmap
