// A module as ours are; built as one of another version, too.

#include "core/modules/counter_module.hpp"

#include <atomic>

#include "cmap/core/loaded_module.hpp"
#include "cmap/core/parallel.hpp"

namespace cmap::testing {
namespace {

int count(int n) {
  std::atomic<int> chunks = 0;
  parallel_chunks(static_cast<std::size_t>(n), 1, [&](std::size_t, std::size_t) { ++chunks; });
  return chunks;
}

constexpr CounterTable kTable{.threads = thread_count, .simd = simd_level, .count = count};

}  // namespace
}  // namespace cmap::testing

cmap::ModuleAnswer cmap_module(const char* build, const cmap::ModuleHost* host) {
#ifdef CMAP_TEST_OTHER_BUILD
  (void)build, (void)host;
  return {CMAP_TEST_OTHER_BUILD, nullptr};
#else
  return cmap::answer_of_module(cmap::testing::kTable, build, host);
#endif
}
