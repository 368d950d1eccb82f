#include "recordings/containers/unpack_zstd.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <memory>

#include "cmap/core/error.hpp"

namespace cmap {

std::size_t unpack_zstd(std::span<const std::byte> packed, std::span<std::byte> out) {
  // A thread's context is kept: making one costs more than a small frame.
  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  thread_local const std::unique_ptr<ZSTD_DCtx, Free> context(ZSTD_createDCtx());
  const std::size_t n = ZSTD_decompressDCtx(context.get(), out.data(), out.size(), packed.data(), packed.size());
  if (ZSTD_isError(n) != 0) throw InputError(fmt::format("zstd: {}", ZSTD_getErrorName(n)));
  return n;
}

}  // namespace cmap
