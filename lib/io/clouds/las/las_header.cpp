#include "clouds/las/las_header.hpp"

#include <algorithm>
#include <cmath>

#include "bytes/little_endian.hpp"

namespace cmap {
namespace {

// Bytes of the header up to the last field used here; 1.3 adds where the waveforms are, 1.4 the 64-bit counts.
constexpr std::size_t kHeaderBytes = 227;
constexpr std::size_t kHeaderBytes13 = 235;
constexpr std::size_t kHeaderBytes14 = 375;
constexpr int kHighestMinor = 5;

// Bits of the global encoding.
constexpr int kWaveformsInside = 2;
constexpr int kWktCounts = 16;

// By point format 0 to 10: smallest record, and where red starts (0: no color).
constexpr std::array<std::size_t, 11> kRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<std::size_t, 11> kRgbOffsets{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

void read_format(const ByteSource& source, std::span<const std::byte> bytes, LasHeader& header) {
  const auto format = load_little<std::uint8_t>(bytes, 104);
  if ((format & 0xc0) != 0) refuse_laz(source);
  if (format > 10) source.fail("header: point format {}; 0 to 10 expected", format);
  header.point_format = format;
  header.record_bytes = load_little<std::uint16_t>(bytes, 105);
  if (header.record_bytes < kRecordBytes[format]) {
    source.fail("header: records of {} bytes, but point format {} takes {}", header.record_bytes, format,
                kRecordBytes[format]);
  }
  header.rgb_offset = kRgbOffsets[format];
}

void read_place(const ByteSource& source, std::span<const std::byte> bytes, LasHeader& header) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    header.scale[axis] = load_little<double>(bytes, 131 + 8 * axis);
    header.offset[axis] = load_little<double>(bytes, 155 + 8 * axis);
    if (!std::isfinite(header.scale[axis]) || header.scale[axis] == 0.0) {
      source.fail("header: {} scale factor {}", "xyz"[axis], header.scale[axis]);
    }
    if (!std::isfinite(header.offset[axis])) source.fail("header: {} offset {}", "xyz"[axis], header.offset[axis]);
  }
}

/// How many points, and what stands behind them.
void read_counts(const ByteSource& source, std::span<const std::byte> bytes, LasHeader& header) {
  header.points = header.legacy_points = load_little<std::uint32_t>(bytes, 107);
  const bool waveforms_inside = (load_little<std::uint16_t>(bytes, 6) & kWaveformsInside) != 0;
  if (header.version_minor >= 3 && header.header_bytes >= kHeaderBytes13 && waveforms_inside) {
    source.require(kHeaderBytes13, "the LAS 1.3 header");
    header.extended_offset = load_little<std::uint64_t>(bytes, 227);  // of the one record that holds them
    header.extended_vlrs = header.extended_offset > 0 ? 1 : 0;
  }
  if (header.version_minor < 4) return;
  source.require(kHeaderBytes14, "the LAS 1.4 header");
  // The 32-bit count is 0 where the points are too many for it, or of a new format.
  if (const auto points = load_little<std::uint64_t>(bytes, 247); points > 0) header.points = points;
  if (const auto records = load_little<std::uint32_t>(bytes, 243); records > 0) {
    header.extended_vlrs = records;
    header.extended_offset = load_little<std::uint64_t>(bytes, 235);
  }
}

}  // namespace

void refuse_laz(const ByteSource& source) {
  const std::string& in = source.name();
  const std::string stem = in.substr(0, in.find_last_of('.') == std::string::npos ? in.size() : in.find_last_of('.'));
  source.fail("is compressed (LAZ); convert it first: laszip -i {0} -o {1}.las, or pdal translate {0} {1}.las", in,
              stem);
}

LasHeader read_las_header(ByteSource& source) {
  const auto bytes = source.peek(std::min<std::uint64_t>(kHeaderBytes14, source.size()));
  source.require(kHeaderBytes, "the LAS header");
  LasHeader header;
  const auto major = load_little<std::uint8_t>(bytes, 24);
  header.version_minor = load_little<std::uint8_t>(bytes, 25);
  if (major != 1 || header.version_minor > kHighestMinor) {
    source.fail("header: LAS version {}.{}; 1.0 to 1.{} expected", major, header.version_minor, kHighestMinor);
  }
  header.wkt_counts = (load_little<std::uint16_t>(bytes, 6) & kWktCounts) != 0;
  read_format(source, bytes, header);
  read_place(source, bytes, header);
  header.header_bytes = load_little<std::uint16_t>(bytes, 94);
  header.data_offset = load_little<std::uint32_t>(bytes, 96);
  header.vlrs = load_little<std::uint32_t>(bytes, 100);
  read_counts(source, bytes, header);
  if (header.data_offset < header.header_bytes || header.data_offset < kHeaderBytes) {
    source.fail("header: points from byte {} on, inside the header", header.data_offset);
  }
  return header;
}

}  // namespace cmap
