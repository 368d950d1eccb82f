#include "cmap/core/array.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <new>
#include <string>

namespace cmap {
namespace array_test {

constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kMiB = std::size_t{1} << 20;
constexpr std::size_t kMaxSize = std::numeric_limits<std::size_t>::max();

std::uintptr_t address(const void* memory) { return reinterpret_cast<std::uintptr_t>(memory); }

TEST(Array, StartsAtACacheLine) {
  // Several at once: a single block could be aligned by luck.
  std::vector<Array<std::uint8_t>> arrays;
  for (std::size_t n = 1; n < 200; n += 3) {
    arrays.emplace_back(n);
    EXPECT_EQ(address(arrays.back().data()) % kCacheLine, 0u) << n << " bytes";
  }
}

TEST(Array, LargeOnesStartAtAHugePage) {
  const Array<double> exactly_4_MiB(4 * kMiB / sizeof(double));
  const Array<double> a_bit_more(4 * kMiB / sizeof(double) + 1);
  EXPECT_EQ(address(exactly_4_MiB.data()) % (2 * kMiB), 0u);
  EXPECT_EQ(address(a_bit_more.data()) % (2 * kMiB), 0u);
}

TEST(Array, ResizeLeavesPlainElementsUninitialized) {
  // Unsigned char, because it is the type whose uninitialized values may be read.
  Array<unsigned char> values(1000, 7);
  values.clear();
  values.resize(1000);
  EXPECT_EQ(values, Array<unsigned char>(1000, 7));
}

TEST(Array, ResizeWithAValueInitializes) {
  Array<int> values(3, 1);
  values.resize(5, 9);
  values.push_back(4);
  values.emplace_back(5);
  EXPECT_EQ(values, (Array<int>{1, 1, 1, 9, 9, 4, 5}));
}

TEST(Array, ElementsWithAConstructorAreConstructed) {
  Array<std::string> names(2);
  names.resize(4);
  names.emplace_back(40, 'x');  // longer than what a string keeps in place
  EXPECT_EQ(names, (Array<std::string>{"", "", "", "", std::string(40, 'x')}));
}

TEST(Array, GrowingAndMovingKeepTheElements) {
  Array<int> values;
  for (int i = 0; i < 3'000'000; ++i) values.push_back(i);  // across the border to huge pages
  const int* memory = values.data();
  const Array<int> moved = std::move(values);
  EXPECT_EQ(moved.data(), memory);
  for (int i = 0; i < 3'000'000; ++i) ASSERT_EQ(moved[static_cast<std::size_t>(i)], i);
}

TEST(AllocateLarge, NoBytesAreStillAnAddress) {
  void* memory = allocate_large(0);
  EXPECT_NE(memory, nullptr);
  free_large(memory, 0);
}

TEST(AllocateLarge, AFreedBlockServesTheNextArrayOfItsSize) {
  void* first = allocate_large(40 * kMiB);
  free_large(first, 40 * kMiB);
  void* smaller = allocate_large(36 * kMiB);
  EXPECT_EQ(smaller, first);
  // Freed by its smaller size it is still the block of 40 MiB.
  free_large(smaller, 36 * kMiB);
  void* again = allocate_large(40 * kMiB);
  EXPECT_EQ(again, first);
  // A third of it would waste the rest.
  free_large(again, 40 * kMiB);
  void* third = allocate_large(13 * kMiB);
  EXPECT_NE(third, first);
  free_large(third, 13 * kMiB);
}

TEST(AllocateLarge, SizesThatOverflowAreRefused) {
  // Rounded up to whole huge pages these would wrap around to almost nothing.
  EXPECT_THROW(allocate_large(kMaxSize), std::bad_alloc);
  EXPECT_THROW(allocate_large(kMaxSize - 2 * kMiB + 1), std::bad_alloc);
}

TEST(LargeAllocator, CountsThatOverflowAreRefused) {
  LargeAllocator<double> allocator;
  // 8 * (2^61 + 1) is 8 modulo 2^64.
  EXPECT_THROW(allocator.deallocate(allocator.allocate(kMaxSize / 8 + 2), 0), std::bad_array_new_length);
}

}  // namespace array_test
}  // namespace cmap
