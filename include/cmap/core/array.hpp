#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace cmap {

/// Memory for large arrays: 64-byte aligned; from 4 MiB on in huge pages, and kept when freed, for the next array of
/// about its size: the first touch of fresh memory costs more than most passes over it. Idle blocks go back to the
/// system before the process would grow. Thread-safe. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);
void free_large(void* memory, std::size_t bytes) noexcept;

/// Allocator of Array: aligned memory whose elements are left uninitialized by `resize`, so that a large array is
/// touched once, by whoever fills it.
template <class T>
struct LargeAllocator {
  using value_type = T;
  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>&) noexcept {}

  T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(allocate_large(n * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t n) noexcept { free_large(memory, n * sizeof(T)); }

  template <class U>
  void construct(U* place) noexcept(noexcept(::new (static_cast<void*>(place)) U)) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Args>
  void construct(U* place, Args&&... args) {
    ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
  }
  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
};

/// A std::vector for millions of elements: `Array<T>(n)` and `resize(n)` do not initialize plain types.
template <class T>
using Array = std::vector<T, LargeAllocator<T>>;

}  // namespace cmap
