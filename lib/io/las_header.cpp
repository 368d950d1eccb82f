#include "io/las_header.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace cmap {
namespace {

// Bytes of the header up to the last field used here; 1.4 adds 64-bit counts.
constexpr std::size_t kHeaderBytes = 227;
constexpr std::size_t kHeaderBytes14 = 375;

// By point format 0 to 10: smallest record, and where red starts (0: no color).
constexpr std::array<std::size_t, 11> kRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<std::size_t, 11> kRgbOffset{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

/// A little-endian number at a fixed place of the header.
template <class T>
T load(std::span<const std::byte> header, std::size_t offset) {
  std::array<std::byte, sizeof(T)> bytes;
  std::memcpy(bytes.data(), header.data() + offset, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

void refuse_laz(const ByteSource& source) {
  const std::string& in = source.name();
  const std::string stem = in.substr(0, in.find_last_of('.') == std::string::npos ? in.size() : in.find_last_of('.'));
  source.fail("is compressed (LAZ); convert it first: laszip -i {0} -o {1}.las, or pdal translate {0} {1}.las", in,
              stem);
}

void read_format(const ByteSource& source, std::span<const std::byte> bytes, LasHeader& header) {
  const auto format = load<std::uint8_t>(bytes, 104);
  if ((format & 0xc0) != 0) refuse_laz(source);
  if (format > 10) source.fail("header: point format {}; 0 to 10 expected", format);
  header.point_format = format;
  header.record_bytes = load<std::uint16_t>(bytes, 105);
  if (header.record_bytes < kRecordBytes[format]) {
    source.fail("header: records of {} bytes, but point format {} takes {}", header.record_bytes, format,
                kRecordBytes[format]);
  }
  header.rgb_offset = kRgbOffset[format];
}

void read_place(const ByteSource& source, std::span<const std::byte> bytes, LasHeader& header) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    header.scale[axis] = load<double>(bytes, 131 + 8 * axis);
    header.offset[axis] = load<double>(bytes, 155 + 8 * axis);
    if (!std::isfinite(header.scale[axis]) || header.scale[axis] == 0.0) {
      source.fail("header: {} scale factor {}", "xyz"[axis], header.scale[axis]);
    }
    if (!std::isfinite(header.offset[axis])) source.fail("header: {} offset {}", "xyz"[axis], header.offset[axis]);
  }
}

/// Converters that leave the compression bit out still describe their compression in a variable-length record.
void refuse_laszip_record(const ByteSource& source, std::span<const std::byte> bytes, std::uint64_t header_bytes,
                          std::uint32_t n_records) {
  std::uint64_t place = header_bytes;
  for (std::uint32_t i = 0; i < n_records && place + 54 <= bytes.size(); ++i) {
    constexpr std::string_view kUser = "laszip encoded";
    if (std::memcmp(bytes.data() + place + 2, kUser.data(), kUser.size()) == 0) refuse_laz(source);
    place += 54 + load<std::uint16_t>(bytes, place + 20);
  }
}

}  // namespace

LasHeader read_las_header(ByteSource& source) {
  const auto bytes = source.peek(std::min<std::uint64_t>(source.block_bytes(), source.size()));
  source.require(kHeaderBytes, "the LAS header");
  LasHeader header;
  const auto major = load<std::uint8_t>(bytes, 24);
  header.version_minor = load<std::uint8_t>(bytes, 25);
  if (major != 1 || header.version_minor > 4) {
    source.fail("header: LAS version {}.{}; 1.0 to 1.4 expected", major, header.version_minor);
  }
  read_format(source, bytes, header);
  read_place(source, bytes, header);
  const auto header_bytes = load<std::uint16_t>(bytes, 94);
  refuse_laszip_record(source, bytes, header_bytes, load<std::uint32_t>(bytes, 100));
  header.data_offset = load<std::uint32_t>(bytes, 96);
  header.points = load<std::uint32_t>(bytes, 107);
  if (header.version_minor == 4) {
    source.require(kHeaderBytes14, "the LAS 1.4 header");
    // The 32-bit count is 0 where the points are too many for it, or of a new format.
    if (const auto points = load<std::uint64_t>(bytes, 247); points > 0) header.points = points;
  }
  if (header.data_offset < header_bytes || header.data_offset < kHeaderBytes) {
    source.fail("header: points from byte {} on, inside the header", header.data_offset);
  }
  return header;
}

}  // namespace cmap
