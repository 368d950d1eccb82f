#include "cmap/io/lidar_scan_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>

#include "captures/kitti_scan.hpp"
#include "clouds/pcd/pcd_body.hpp"
#include "cmap/io/number_text.hpp"
#include "cmap/io/output_file.hpp"
#include "cmap/io/row_writer.hpp"
#include "containers/lzf_codec.hpp"

namespace cmap {
namespace {

enum Value : std::size_t { kX, kY, kZ, kIntensity, kTime, kRing, kValues };
constexpr std::array<std::string_view, kValues> kValueNames{"x", "y", "z", "intensity", "time", "ring"};

/// Which field of the file holds each value; none: the file has no such field.
using FieldOf = std::array<std::optional<std::size_t>, kValues>;

FieldOf find_fields(const ByteSource& source, const PcdHeader& header) {
  FieldOf field_of;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    const auto known = std::find(kValueNames.begin(), kValueNames.end(), header.fields[i].name);
    if (known == kValueNames.end()) continue;
    auto& place = field_of[static_cast<std::size_t>(known - kValueNames.begin())];
    if (place) source.fail("header: the field '{}' is declared twice", *known);
    if (!header.fields[i].is_scalar()) source.fail("header: the field '{}' is not a single number", *known);
    place = i;
  }
  for (const Value axis : {kX, kY, kZ}) {
    if (!field_of[axis]) source.fail("header: points have no field '{}'", kValueNames[axis]);
  }
  return field_of;
}

std::size_t record_bytes(const ByteSource& source, const PcdHeader& header) {
  std::size_t bytes = 0;
  for (const Field& field : header.fields) {
    bytes += field.count * scalar_bytes(field.type);  // a count is at most kMaxRecordBytes
    if (bytes > ByteSource::kMaxRecordBytes) {
      source.fail("header: a point takes more than the accepted {} bytes", ByteSource::kMaxRecordBytes);
    }
  }
  return bytes;
}

/// The body of a file in memory, and where in it the fields are.
struct Body {
  Array<std::byte> bytes;
  std::vector<Column> columns;
};

Body read_binary_body(ByteSource& source, const PcdHeader& header) {
  const std::size_t stride = record_bytes(source, header);
  if (header.points > source.remaining() / stride) {
    source.fail("truncated: {} points of {} bytes from byte {} on do not fit into {} bytes", header.points, stride,
                source.position(), source.size());
  }
  Body body{Array<std::byte>(header.points * stride), {}};
  source.read(body.bytes, "the points");
  const std::byte* place = body.bytes.data();
  for (const Field& field : header.fields) {
    body.columns.push_back({place, stride, field.type});
    place += field.count * scalar_bytes(field.type);
  }
  return body;
}

Body read_compressed_body(ByteSource& source, const PcdHeader& header) {
  Body body{read_compressed_pcd_body(source, header.points, record_bytes(source, header)), {}};
  body.columns = compressed_columns(header, body.bytes);
  return body;
}

/// One line of numbers, those of fields with a count greater than 1 passed over.
void parse_row(const LineReader& lines, std::string_view line, const PcdHeader& header, double* row) {
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    for (std::size_t k = 0; k < header.fields[i].count; ++k) {
      const std::string_view token = next_token(line);
      if (token.empty()) lines.fail("ends before the value of '{}'", header.fields[i].name);
      if (!parse_number(token, row[i])) lines.fail("'{}' is not a number", token.substr(0, 40));
    }
  }
  if (const auto extra = next_token(line); !extra.empty())
    lines.fail("'{}' follows the last value", extra.substr(0, 40));
}

Body read_ascii_body(LineReader& lines, const PcdHeader& header) {
  ByteSource& source = lines.source();
  const std::size_t fields = header.fields.size();
  if (header.points > (source.remaining() + 1) / (2 * fields)) {  // a digit and what ends it
    source.fail("truncated: {} lines of {} values from byte {} on do not fit into {} bytes", header.points, fields,
                source.position(), source.size());
  }
  Body body{Array<std::byte>(header.points * fields * sizeof(double)), {}};
  std::vector<double> row(fields);
  std::string_view line;
  for (std::uint64_t i = 0; i < header.points; ++i) {
    do {
      if (!lines.next(line)) source.fail("truncated: {} of {} points", i, header.points);
    } while (line.find_first_not_of(" \t\r") == std::string_view::npos);
    parse_row(lines, line, header, row.data());
    std::memcpy(body.bytes.data() + i * fields * sizeof(double), row.data(), fields * sizeof(double));
  }
  for (std::size_t k = 0; k < fields; ++k) {
    body.columns.push_back({body.bytes.data() + k * sizeof(double), fields * sizeof(double), ScalarType::kFloat64});
  }
  return body;
}

Body read_body(LineReader& lines, const PcdHeader& header) {
  if (header.points == 0) return {{}, std::vector<Column>(header.fields.size())};
  if (header.data == PcdData::kAscii) return read_ascii_body(lines, header);
  return header.data == PcdData::kBinary ? read_binary_body(lines.source(), header)
                                         : read_compressed_body(lines.source(), header);
}

double value_at(const Column& column, std::size_t i) {
  return visit_scalar(column.type, [&]<class T>(T value) {
    std::memcpy(&value, column.data + i * column.stride, sizeof(T));
    return static_cast<double>(value);
  });
}

void check_time(const ByteSource& source, std::size_t i, double time_s) {
  constexpr double kFarthest_s = 60.0;
  if (std::abs(time_s) <= kFarthest_s) return;
  source.fail("point {}: time {:g}; at most {:g} seconds from the scan's stamp expected", i + 1, time_s, kFarthest_s);
}

std::uint16_t ring_of(const ByteSource& source, std::size_t i, double ring) {
  if (ring >= 0.0 && ring <= 65535.0 && ring == std::floor(ring)) return static_cast<std::uint16_t>(ring);
  source.fail("point {}: ring {:g}; a whole number of 16 bits expected", i + 1, ring);
}

LidarScan collect(const ByteSource& source, const Body& body, const FieldOf& field_of, std::uint64_t points) {
  LidarScan scan;
  std::array<double, kValues> value{};
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t k = 0; k < kValues; ++k) value[k] = field_of[k] ? value_at(body.columns[*field_of[k]], i) : 0.0;
    const Eigen::Vector3f position(static_cast<float>(value[kX]), static_cast<float>(value[kY]),
                                   static_cast<float>(value[kZ]));
    if (!position.allFinite() || !std::isfinite(value[kIntensity]) || !std::isfinite(value[kTime])) continue;
    scan.positions.push_back(position);
    if (field_of[kIntensity]) scan.intensity.push_back(static_cast<float>(value[kIntensity]));
    if (field_of[kTime]) {
      check_time(source, i, value[kTime]);
      scan.time_s.push_back(static_cast<float>(value[kTime]));
    }
    if (field_of[kRing]) scan.ring.push_back(ring_of(source, i, value[kRing]));
  }
  return scan;
}

std::string scan_header(const LidarScan& scan) {
  std::string fields = "x y z", sizes = "4 4 4", types = "F F F", counts = "1 1 1";
  const auto add = [&](bool present, std::string_view field, std::string_view size, std::string_view type) {
    if (!present) return;
    fields += fmt::format(" {}", field);
    sizes += fmt::format(" {}", size);
    types += fmt::format(" {}", type);
    counts += " 1";
  };
  add(!scan.intensity.empty(), "intensity", "4", "F");
  add(!scan.time_s.empty(), "time", "4", "F");
  add(!scan.ring.empty(), "ring", "2", "U");
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\n"
      "WIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      fields, sizes, types, counts, scan.positions.size(), scan.positions.size());
}

}  // namespace

LidarScan read_lidar_scan(const std::filesystem::path& path, double timestamp_s) {
  if (is_kitti_scan(path)) return read_kitti_scan(path, timestamp_s);
  ByteSource source(path);
  LineReader lines(source);
  FileInfo info;
  const PcdHeader header = read_pcd_header(lines, info);
  const FieldOf field_of = find_fields(source, header);
  LidarScan scan = collect(source, read_body(lines, header), field_of, header.points);
  scan.timestamp_s = timestamp_s;
  return scan;
}

void write_lidar_scan(const LidarScan& scan, const std::filesystem::path& path) {
  const std::size_t n = scan.positions.size();
  for (const std::size_t length : {scan.intensity.size(), scan.time_s.size(), scan.ring.size()}) {
    if (length != 0 && length != n) throw std::invalid_argument("write_lidar_scan: arrays of different lengths");
  }
  OutputFile file(path);
  file.write(scan_header(scan));
  RowWriter writer(file);
  for (std::size_t i = 0; i < n; ++i) {
    for (int axis = 0; axis < 3; ++axis) writer.put_binary(scan.positions[i][axis]);
    if (!scan.intensity.empty()) writer.put_binary(scan.intensity[i]);
    if (!scan.time_s.empty()) writer.put_binary(scan.time_s[i]);
    if (!scan.ring.empty()) writer.put_binary(scan.ring[i]);
    writer.end_row();
  }
  writer.flush();
  file.commit();
}

}  // namespace cmap
