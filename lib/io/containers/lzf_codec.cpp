#include "containers/lzf_codec.hpp"

#include <lzf.h>

#include <limits>

namespace cmap {
namespace {
constexpr std::size_t kMostLzfBytes = std::numeric_limits<unsigned int>::max();
}  // namespace

bool lzf_expand(std::span<const std::byte> compressed, std::span<std::byte> out) {
  if (compressed.size() > kMostLzfBytes || out.size() > kMostLzfBytes) return false;
  return lzf_decompress(compressed.data(), static_cast<unsigned int>(compressed.size()), out.data(),
                        static_cast<unsigned int>(out.size())) == out.size();
}

Array<std::byte> lzf_shrink(std::span<const std::byte> bytes) {
  // Incompressible bytes grow by 1 in 32.
  const std::size_t room = bytes.size() + bytes.size() / 16 + 64;
  if (room > kMostLzfBytes) return {};
  Array<std::byte> compressed(room);
  compressed.resize(lzf_compress(bytes.data(), static_cast<unsigned int>(bytes.size()), compressed.data(),
                                 static_cast<unsigned int>(room)));
  return compressed;
}

}  // namespace cmap
