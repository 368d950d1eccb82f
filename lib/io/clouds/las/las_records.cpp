#include "clouds/las/las_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "bytes/little_endian.hpp"

namespace cmap {
namespace {

// Longer texts describe no coordinate system.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 20;

constexpr int kGeoKeys = 34735;
constexpr int kGeoDoubles = 34736;
constexpr int kWkt = 2112;

/// A list of records, one after another: `n` of them from byte `begin` on, none beyond `end`.
struct RecordList {
  const char* where;
  std::uint64_t n, begin, end;
  bool extended;  ///< 64-bit lengths

  std::size_t header_bytes() const { return extended ? 60 : 54; }
};

struct Record {
  std::string_view user;
  int id;
  std::uint64_t place, bytes;  ///< of its content
};

void warn_of_damage(const RecordList& list, std::uint64_t i, FileInfo& info) {
  info.warnings.push_back(
      {"damaged_record", fmt::format("record {} of {} {} is damaged; it and what follows of them is not read", i + 1,
                                     list.n, list.where)});
}

/// Calls use(record) for each record; returns where the last whole one ends.
template <class Use>
std::uint64_t walk(const ByteSource& source, const RecordList& list, FileInfo& info, Use&& use) {
  std::uint64_t place = list.begin;
  for (std::uint64_t i = 0; i < list.n; ++i) {
    std::array<std::byte, 60> header{};
    const std::span<std::byte> bytes(header.data(), list.header_bytes());
    if (list.end - place < bytes.size() || source.read_at(place, bytes) < bytes.size()) {
      warn_of_damage(list, i, info);
      break;
    }
    const std::string_view user(reinterpret_cast<const char*>(bytes.data()) + 2, 16);
    const Record record{user.substr(0, user.find('\0')), load_little<std::uint16_t>(bytes, 18), place + bytes.size(),
                        list.extended ? load_little<std::uint64_t>(bytes, 20) : load_little<std::uint16_t>(bytes, 20)};
    if (record.bytes > list.end - record.place) {
      warn_of_damage(list, i, info);
      break;
    }
    use(record);
    place = record.place + record.bytes;
  }
  return place;
}

std::vector<std::byte> content(const ByteSource& source, const Record& record) {
  std::vector<std::byte> bytes(std::min(record.bytes, kMostBytes));
  bytes.resize(source.read_at(record.place, bytes));
  return bytes;
}

/// Keeps what describes the coordinate system; the first of a kind counts. libLAS wrote WKT under its own name.
void keep(const ByteSource& source, const Record& record, LasRecords& records) {
  const bool official = record.user == "LASF_Projection";
  if (record.id == kWkt && records.wkt.empty() && (official || record.user == "liblas")) {
    const std::vector<std::byte> bytes = content(source, record);
    records.wkt.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  } else if (record.id == kGeoKeys && official && records.geo_keys.empty()) {
    records.geo_keys = content(source, record);
  } else if (record.id == kGeoDoubles && official && records.geo_doubles.empty()) {
    records.geo_doubles = content(source, record);
  }
}

}  // namespace

LasRecords read_las_records(const ByteSource& source, const LasHeader& header, FileInfo& info) {
  LasRecords records;
  const std::uint64_t end = std::min(header.data_offset, source.size());
  const RecordList list{"before the points", header.vlrs, std::min(header.header_bytes, end), end, false};
  walk(source, list, info, [&](const Record& record) {
    // Converters that leave the compression bit out still describe their compression.
    if (record.user.starts_with("laszip encoded")) refuse_laz(source);
    keep(source, record, records);
  });
  return records;
}

void read_extended_records(const ByteSource& source, const LasHeader& header, LasRecords& records, FileInfo& info) {
  if (header.extended_vlrs == 0) return;
  const std::uint64_t begin = header.extended_offset;
  const RecordList list{"behind the points", header.extended_vlrs, begin, source.size(), true};
  if (begin < header.data_end() || begin > source.size()) return warn_of_damage(list, 0, info);
  records.extended_bytes = walk(source, list, info, [&](const Record& r) { keep(source, r, records); }) - begin;
}

}  // namespace cmap
