#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/io_testing.hpp"

namespace cmap::testing {

/// A variable-length record before or behind the points.
struct LasRecord {
  std::string user;
  U16 id = 0;
  std::string content;

  std::string bytes(bool extended) const {
    Bytes bytes(std::string(2, '\0') + user + std::string(16 - user.size(), '\0'));
    bytes.put(id);
    if (extended) {
      bytes.put(std::uint64_t{content.size()});
    } else {
      bytes.put(static_cast<U16>(content.size()));
    }
    return bytes.text(std::string(32, '\0')).text(content).str();
  }
};

inline LasRecord wkt_record(const std::string& wkt) { return {"LASF_Projection", 2112, wkt}; }

/// Key, place (0: the value itself), count, value.
using GeoKey = std::array<U16, 4>;

inline std::string geo_key_directory(const std::vector<GeoKey>& keys) {
  Bytes bytes;
  bytes.put(U16{1}, U16{1}, U16{0}, static_cast<U16>(keys.size()));
  for (const GeoKey& key : keys) bytes.put(key[0], key[1], key[2], key[3]);
  return bytes.str();
}

inline LasRecord geo_keys_record(const std::vector<GeoKey>& keys) {
  return {"LASF_Projection", 34735, geo_key_directory(keys)};
}

/// A LAS file with these points; every record has `extra` bytes of its own at the end.
struct Las {
  U8 minor = 2;
  U8 format = 3;
  U16 extra = 0;
  std::uint32_t gap = 0;  ///< bytes between header and points, behind the records there
  std::array<double, 3> scale{0.01, 0.01, 0.001};
  std::array<double, 3> offset{500000, 4000000, 0};
  std::vector<std::array<std::int32_t, 3>> points{{1, 2, 3}};
  std::vector<Rgb16> colors{{256, 512, 65535}};
  std::vector<U8> classes = {};   ///< of each point; empty: 2 throughout
  std::vector<U8> withheld = {};  ///< 1 for those that are; empty: none
  std::vector<LasRecord> records = {}, extended_records = {};
  U16 global_encoding = 0;

  static constexpr std::array<U16, 11> kRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  static constexpr std::array<std::size_t, 11> kRgbOffset{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

  std::size_t header_bytes() const { return std::array<std::size_t, 6>{227, 227, 227, 235, 375, 393}[minor]; }
  std::size_t record_bytes() const { return std::size_t{kRecordBytes[format]} + extra; }
  std::string before() const {
    std::string bytes;
    for (const LasRecord& record : records) bytes += record.bytes(false);
    return bytes + std::string(gap, '#');
  }
  std::size_t data_offset() const { return header_bytes() + before().size(); }

  Bytes header() const {
    Bytes bytes(std::string(header_bytes(), '\0'));
    const auto n = static_cast<std::uint32_t>(points.size());
    bytes.set(0, std::array{'L', 'A', 'S', 'F'}).set(6, global_encoding).set(24, U8{1}).set(25, minor);
    bytes.set(94, static_cast<U16>(header_bytes())).set(96, static_cast<std::uint32_t>(data_offset()));
    bytes.set(100, static_cast<std::uint32_t>(records.size()));
    bytes.set(104, format).set(105, static_cast<U16>(record_bytes()));
    bytes.set(131, scale).set(155, offset);
    if (minor < 4 || format < 6) bytes.set(107, n);
    if (minor >= 4) bytes.set(247, std::uint64_t{n});
    if (!extended_records.empty()) {
      bytes.set(235, std::uint64_t{data_offset() + n * record_bytes()});
      bytes.set(243, static_cast<std::uint32_t>(extended_records.size()));
    }
    return bytes;
  }

  std::string record(std::size_t i) const {
    Bytes bytes(std::string(record_bytes(), '\x5a'));
    bytes.set(0, points[i]);
    const U8 number = classes.empty() ? U8{2} : classes[i];
    const bool hidden = !withheld.empty() && withheld[i] != 0;
    // All other flags are set: synthetic, key point, and overlap where there is one.
    if (format < 6) {
      bytes.set(15, static_cast<U8>(number | 0x60 | (hidden ? 0x80 : 0)));
    } else {
      bytes.set(15, static_cast<U8>(0xfb | (hidden ? 0x04 : 0))).set(16, number);
    }
    if (kRgbOffset[format] > 0) bytes.set(kRgbOffset[format], colors[i % colors.size()]);
    return bytes.str();
  }

  Bytes file() const {
    Bytes bytes = header();
    bytes.text(before());
    for (std::size_t i = 0; i < points.size(); ++i) bytes.text(record(i));
    for (const LasRecord& record : extended_records) bytes.text(record.bytes(true));
    return bytes;
  }
};

inline std::string all_warnings(const PointCloudFile& file) {
  std::string text;
  for (const Warning& warning : file.info.warnings) text += warning.id + ": " + warning.message + "\n";
  return text;
}

}  // namespace cmap::testing
