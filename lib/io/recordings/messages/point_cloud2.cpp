#include "recordings/messages/point_cloud2.hpp"

#include <optional>

namespace cmap {
namespace {

std::optional<ScalarType> type_of_datatype(std::uint8_t datatype) {
  constexpr std::array kTypes{ScalarType::kInt8,  ScalarType::kUint8,  ScalarType::kInt16,   ScalarType::kUint16,
                              ScalarType::kInt32, ScalarType::kUint32, ScalarType::kFloat32, ScalarType::kFloat64};
  if (datatype < 1 || datatype > kTypes.size()) return std::nullopt;
  return kTypes[datatype - 1U];
}

/// Fields of types that are not known can be stepped over, as each says where it is.
void read_fields(WireReader& reader, PointCloud2& cloud) {
  constexpr std::size_t kLeastBytes = 13;
  const std::uint32_t n = reader.count(kLeastBytes);
  for (std::uint32_t i = 0; i < n; ++i) {
    CloudField field;
    field.name = reader.text();
    field.offset = reader.number<std::uint32_t>();
    const std::optional<ScalarType> type = type_of_datatype(reader.number<std::uint8_t>());
    reader.number<std::uint32_t>();  // how many; of several, the first
    if (!type) continue;
    field.type = *type;
    cloud.fields.push_back(std::move(field));
  }
}

/// Rows may be padded; of a single row, publishers leave its length 0.
void check_layout(const WireReader& reader, PointCloud2& cloud) {
  const std::uint64_t row_bytes = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.height <= 1 && cloud.row_step < row_bytes) cloud.row_step = row_bytes;
  if (cloud.row_step < row_bytes) {
    reader.fail("rows of {} bytes cannot hold {} points of {} bytes", cloud.row_step, cloud.width, cloud.point_step);
  }
  if (cloud.height == 0 || cloud.width == 0) {
    cloud.height = cloud.width = 0;
    return;
  }
  const std::uint64_t most_rows =
      (cloud.data.size() + (cloud.row_step - row_bytes)) / std::max<std::size_t>(cloud.row_step, 1);
  if (cloud.point_step == 0 || cloud.height > most_rows) {
    reader.fail("{} x {} points of {} bytes in rows of {} do not fit into {} bytes of data", cloud.height, cloud.width,
                cloud.point_step, cloud.row_step, cloud.data.size());
  }
  for (const CloudField& field : cloud.fields) {
    if (field.offset + std::uint64_t{scalar_bytes(field.type)} <= cloud.point_step) continue;
    reader.fail("the field '{}' at byte {} does not fit into points of {} bytes", field.name, field.offset,
                cloud.point_step);
  }
}

}  // namespace

const CloudField* PointCloud2::find(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names) {
    for (const CloudField& field : fields) {
      if (field.name == name) return &field;
    }
  }
  return nullptr;
}

PointCloud2 read_point_cloud2(WireReader& reader) {
  PointCloud2 cloud;
  cloud.header = reader.header();
  cloud.height = reader.number<std::uint32_t>();
  cloud.width = reader.number<std::uint32_t>();
  read_fields(reader, cloud);
  cloud.is_big_endian = reader.number<std::uint8_t>() != 0;
  cloud.point_step = reader.number<std::uint32_t>();
  cloud.row_step = reader.number<std::uint32_t>();
  cloud.data = reader.blob();
  check_layout(reader, cloud);
  return cloud;
}

}  // namespace cmap
