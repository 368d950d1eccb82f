#include "recordings/mcap/mcap_chunk.hpp"

#include <fmt/format.h>
#include <lz4frame.h>

#include "cmap/core/error.hpp"
#include "recordings/containers/unpack_zstd.hpp"
#include "recordings/mcap/crc32.hpp"

namespace cmap::mcap {
namespace {

struct Lz4Context {
  Lz4Context() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  }
  ~Lz4Context() { LZ4F_freeDecompressionContext(context); }
  Lz4Context(const Lz4Context&) = delete;
  Lz4Context& operator=(const Lz4Context&) = delete;
  LZ4F_dctx* context = nullptr;
};

/// The number of bytes unpacked. LZ4 frames, one after another.
std::size_t unpack_lz4(std::span<const std::byte> packed, std::span<std::byte> out) {
  const Lz4Context lz4;
  std::size_t filled = 0;
  while (!packed.empty()) {
    std::size_t n_out = out.size() - filled, n_in = packed.size();
    const std::size_t result = LZ4F_decompress(lz4.context, out.data() + filled, &n_out, packed.data(), &n_in, nullptr);
    if (LZ4F_isError(result) != 0) throw InputError(fmt::format("lz4: {}", LZ4F_getErrorName(result)));
    if (n_out == 0 && n_in == 0) throw InputError("lz4: more than the chunk says");
    filled += n_out;
    packed = packed.subspan(n_in);
  }
  return filled;
}

std::size_t unpack(const std::string& compression, std::span<const std::byte> packed, std::span<std::byte> out) {
  if (compression == "lz4") return unpack_lz4(packed, out);
  if (compression == "zstd") return unpack_zstd(packed, out);
  throw UnsupportedError(
      fmt::format("compression \"{}\"; none, lz4 and zstd are read (mcap compress writes them)", compression));
}

}  // namespace

void check_crc(std::uint32_t crc, std::span<const std::byte> bytes) {
  if (crc == 0) return;
  const std::uint32_t found = crc32_of(bytes);
  if (found != crc) throw InputError(fmt::format("checksum 0x{:08x}, but the bytes have 0x{:08x}", crc, found));
}

std::span<const std::byte> unpack_chunk(const ChunkStart& start, std::span<const std::byte> packed,
                                        Array<std::byte>& room) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
  if (start.uncompressed_bytes > kMost) {
    throw InputError(fmt::format("{} bytes unpacked; at most {} are read", start.uncompressed_bytes, kMost));
  }
  std::span<const std::byte> records = packed;
  if (!start.compression.empty()) {
    constexpr std::uint64_t kMostOfLz4 = 255;
    if (start.compression == "lz4" && start.uncompressed_bytes / kMostOfLz4 > packed.size()) {
      throw InputError(fmt::format("{} bytes of lz4 cannot unpack to {}", packed.size(), start.uncompressed_bytes));
    }
    room.clear();
    room.resize(start.uncompressed_bytes);
    records = std::span(room).first(unpack(start.compression, packed, room));
  }
  if (records.size() != start.uncompressed_bytes) {
    throw InputError(fmt::format("{} bytes unpacked, but {} expected", records.size(), start.uncompressed_bytes));
  }
  check_crc(start.crc, records);
  return records;
}

}  // namespace cmap::mcap
