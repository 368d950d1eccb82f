#include "clouds/pcd/pcd_body.hpp"

#include <array>

#include "containers/lzf_codec.hpp"

namespace cmap {
namespace {

std::uint32_t read_size(ByteSource& source) {
  std::array<std::byte, 4> bytes;
  source.read(bytes, "a size of the compressed body");
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) size |= std::to_integer<std::uint32_t>(bytes[i]) << (8 * i);
  return size;
}

}  // namespace

Array<std::byte> read_compressed_pcd_body(ByteSource& source, std::uint64_t points, std::size_t record_bytes) {
  const std::uint64_t start = source.position();
  const std::uint32_t compressed_bytes = read_size(source);
  const std::uint32_t body_bytes = read_size(source);
  if (points > body_bytes / record_bytes || points * record_bytes != body_bytes) {
    source.fail("byte {}: {} points of {} bytes do not make the {} bytes that the compressed body declares", start + 4,
                points, record_bytes, body_bytes);
  }
  source.require(compressed_bytes, "the compressed body");
  if (body_bytes > lzf_max_size(compressed_bytes)) {
    source.fail("byte {}: {} compressed bytes cannot hold {}", start, compressed_bytes, body_bytes);
  }
  Array<std::byte> compressed(compressed_bytes);
  source.read(compressed, "the compressed body");
  Array<std::byte> body(body_bytes);
  if (!lzf_expand(compressed, body)) source.fail("byte {}: the compressed body is damaged", start + 8);
  return body;
}

std::vector<Column> compressed_columns(const PcdHeader& header, const Array<std::byte>& body) {
  std::vector<Column> columns;
  const std::byte* place = body.data();
  for (const Field& field : header.fields) {
    const std::size_t bytes = field.count * scalar_bytes(field.type);
    columns.push_back({place, bytes, field.type});
    place += header.points * bytes;
  }
  return columns;
}

}  // namespace cmap
