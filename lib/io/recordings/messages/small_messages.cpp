#include "recordings/messages/small_messages.hpp"

#include <cmath>

namespace cmap {
namespace {

double finite(WireReader& reader, const char* what) {
  const auto value = reader.number<double>();
  if (!std::isfinite(value)) reader.fail("{} is {}", what, value);
  return value;
}

Eigen::Vector3d vector_of(WireReader& reader, const char* what) {
  const double x = finite(reader, what), y = finite(reader, what), z = finite(reader, what);
  return {x, y, z};
}

Array<std::byte> copy_of(std::span<const std::byte> bytes) {
  Array<std::byte> copy(bytes.size());
  if (!bytes.empty()) std::memcpy(copy.data(), bytes.data(), bytes.size());
  return copy;
}

constexpr std::size_t kCovariance3 = 9;

}  // namespace

ImuSample read_imu_message(WireReader& reader) {
  ImuSample sample;
  sample.time_s = reader.header().stamp_s();
  reader.skip<double>(4 + kCovariance3);  // an orientation that not every IMU has
  sample.angular_rate_radps = vector_of(reader, "an angular velocity");
  reader.skip<double>(kCovariance3);
  sample.specific_force_mps2 = vector_of(reader, "an acceleration");
  reader.skip<double>(kCovariance3);
  return sample;
}

RecordedImage read_image_message(WireReader& reader) {
  constexpr std::uint32_t kMostPixels = 1U << 20;
  RecordedImage image;
  image.time_s = reader.header().stamp_s();
  const auto height = reader.number<std::uint32_t>(), width = reader.number<std::uint32_t>();
  image.encoding = reader.text();
  image.is_big_endian = reader.number<std::uint8_t>() != 0;
  image.row_bytes = reader.number<std::uint32_t>();
  const std::span<const std::byte> data = reader.blob();
  if (height == 0 || width == 0 || height > kMostPixels || width > kMostPixels) {
    reader.fail("an image of {} x {} pixels", width, height);
  }
  if (image.row_bytes < width || height > data.size() / image.row_bytes) {
    reader.fail("{} rows of {} bytes do not fit into {}, or do not hold {} pixels", height, image.row_bytes,
                data.size(), width);
  }
  image.height = static_cast<int>(height);
  image.width = static_cast<int>(width);
  image.bytes = copy_of(data);
  return image;
}

RecordedImage read_compressed_image_message(WireReader& reader) {
  RecordedImage image;
  image.time_s = reader.header().stamp_s();
  const std::string_view format = reader.text();
  const std::span<const std::byte> data = reader.blob();
  const std::string_view start(reinterpret_cast<const char*>(data.data()), std::min<std::size_t>(data.size(), 4));
  if (start.starts_with("\xFF\xD8\xFF")) {
    image.encoding = "jpeg";
  } else if (start == "\x89PNG") {
    image.encoding = "png";
  } else {
    reader.fail("a compressed image of format \"{}\" is neither JPEG nor PNG", format.substr(0, 40));
  }
  image.bytes = copy_of(data);
  return image;
}

StampedPose read_odometry_message(WireReader& reader) {
  StampedPose pose;
  pose.time_s = reader.header().stamp_s();
  reader.text();  // the child frame
  pose.position = vector_of(reader, "a position");
  for (int k = 0; k < 4; ++k) pose.rotation.coeffs()[k] = finite(reader, "a rotation");  // x y z w
  const double norm = pose.rotation.norm();
  if (!(std::abs(norm - 1.0) < 0.1)) reader.fail("a rotation whose quaternion has length {:g}", norm);
  pose.rotation.normalize();
  constexpr std::size_t kCovariance6 = 36, kTwist = 6;
  reader.skip<double>(kCovariance6 + kTwist + kCovariance6);
  return pose;
}

TimeReference read_time_reference_message(WireReader& reader) {
  TimeReference reference;
  reference.header = reader.header();
  reference.reference_ns = reader.time_ns();
  return reference;
}

}  // namespace cmap
