#include "cmap/core/error.hpp"
#include "recordings/containers/unpack_zstd.hpp"

namespace cmap {

std::size_t unpack_zstd(std::span<const std::byte>, std::span<std::byte>) {
  throw UnsupportedError(
      "compression \"zstd\": this build of cmap is without it (apt-get install libzstd-dev, and build again)");
}

}  // namespace cmap
