#include "cmap/core/array.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>

namespace cmap {
namespace {

constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kHugePage = std::size_t{2} << 20;
constexpr std::size_t kHugeFrom = std::size_t{4} << 20;

std::size_t round_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }

/// Freed huge blocks by size, waiting for another use.
class IdleBlocks {
 public:
  /// A block of at least `bytes`, or nullptr. Blocks more than a quarter too large are left for others.
  void* take(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    const auto block = blocks_.lower_bound(bytes);
    if (block == blocks_.end() || block->first - bytes > bytes / 4) return nullptr;
    void* memory = block->second;
    sizes_[memory] = block->first;
    blocks_.erase(block);
    return memory;
  }

  /// Gives blocks back to the system until `bytes` are free, smallest first.
  void make_room(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    for (std::size_t freed = 0; freed < bytes && !blocks_.empty(); blocks_.erase(blocks_.begin())) {
      freed += blocks_.begin()->first;
      std::free(blocks_.begin()->second);
    }
  }

  void put(void* memory, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    // A block that once was larger keeps its size.
    if (const auto known = sizes_.find(memory); known != sizes_.end()) {
      bytes = known->second;
      sizes_.erase(known);
    }
    blocks_.emplace(bytes, memory);
  }

 private:
  std::mutex mutex_;
  std::multimap<std::size_t, void*> blocks_;
  std::map<void*, std::size_t> sizes_;  ///< of reused blocks
};

/// Never destroyed: arrays with static storage may be freed after any destructor of ours. Reachable, so no leak.
IdleBlocks& idle_blocks() {
  static auto* const blocks = new IdleBlocks;
  return *blocks;
}

}  // namespace

void* allocate_large(std::size_t bytes) {
  const bool huge = bytes >= kHugeFrom;
  const std::size_t alignment = huge ? kHugePage : kCacheLine;
  if (bytes > static_cast<std::size_t>(-1) - alignment) throw std::bad_alloc();
  const std::size_t rounded = round_up(std::max<std::size_t>(bytes, 1), alignment);
  if (huge) {
    if (void* idle = idle_blocks().take(rounded)) return idle;
    idle_blocks().make_room(rounded);
  }
  void* memory = std::aligned_alloc(alignment, rounded);
  if (memory == nullptr) throw std::bad_alloc();
  // First touch of 4 KiB pages is several times slower; a refusal costs only speed.
  if (huge) (void)madvise(memory, rounded, MADV_HUGEPAGE);
  return memory;
}

void free_large(void* memory, std::size_t bytes) noexcept {
  if (bytes < kHugeFrom) return std::free(memory);
  try {
    idle_blocks().put(memory, round_up(bytes, kHugePage));
  } catch (...) {
    std::free(memory);
  }
}

}  // namespace cmap
