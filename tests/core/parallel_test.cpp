#include "cmap/core/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <thread>
#include <utility>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"

namespace cmap {
namespace parallel_test {

using Chunk = std::pair<std::size_t, std::size_t>;
constexpr int kThreads[] = {1, 2, 0};  // 0: all the machine has

std::vector<Chunk> chunks_of(std::size_t n, std::size_t chunk_size) {
  std::vector<Chunk> chunks;
  std::mutex mutex;
  parallel_chunks(n, chunk_size, [&](std::size_t begin, std::size_t end) {
    const std::lock_guard lock(mutex);
    chunks.emplace_back(begin, end);
  });
  std::sort(chunks.begin(), chunks.end());
  return chunks;
}

TEST(ExecutionScope, OfOneKeepsEverythingOnTheCaller) {
  const ExecutionScope limit({.threads = 1});
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> elsewhere = 0;
  std::atomic<int> calls = 0;
  const auto look = [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // time for another thread to take one
    ++calls;
    if (std::this_thread::get_id() != caller) ++elsewhere;
  };
  parallel_chunks(20, 1, [&](std::size_t, std::size_t) { look(); });
  parallel_tasks(std::vector<std::function<void()>>(20, look));
  EXPECT_EQ(calls, 40);
  EXPECT_EQ(elsewhere, 0);
}

TEST(ParallelChunks, CoverEveryIndexExactlyOnce) {
  for (int threads : kThreads) {
    const ExecutionScope limit({.threads = threads});
    EXPECT_EQ(chunks_of(10, 4), (std::vector<Chunk>{{0, 4}, {4, 8}, {8, 10}}));
    EXPECT_EQ(chunks_of(8, 4), (std::vector<Chunk>{{0, 4}, {4, 8}}));
    EXPECT_EQ(chunks_of(3, 4), (std::vector<Chunk>{{0, 3}}));
    EXPECT_EQ(chunks_of(0, 4), std::vector<Chunk>{});
    const std::vector<Chunk> many = chunks_of(100'003, 7);
    ASSERT_EQ(many.size(), 14287u);
    for (std::size_t i = 0; i < many.size(); ++i) {
      ASSERT_EQ(many[i], Chunk(7 * i, std::min<std::size_t>(100'003, 7 * i + 7)));
    }
  }
}

TEST(ParallelChunks, AnExceptionReachesTheCaller) {
  for (int threads : kThreads) {
    const ExecutionScope limit({.threads = threads});
    try {
      parallel_chunks(1000, 1, [](std::size_t begin, std::size_t) {
        if (begin == 613) throw InputError("point 613");
      });
      ADD_FAILURE() << "no exception with " << threads << " threads";
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), "point 613");
    }
    EXPECT_EQ(chunks_of(10, 5), (std::vector<Chunk>{{0, 5}, {5, 10}})) << "the next loop must work";
  }
}

TEST(ParallelTasks, EveryTaskRunsOnce) {
  for (int threads : kThreads) {
    const ExecutionScope limit({.threads = threads});
    std::vector<int> runs(50, 0);
    std::vector<std::function<void()>> tasks;
    for (int& run : runs) tasks.emplace_back([&run] { ++run; });
    parallel_tasks(tasks);
    EXPECT_EQ(runs, std::vector<int>(50, 1));
  }
  EXPECT_NO_THROW(parallel_tasks({}));
}

TEST(ParallelTasks, AnExceptionReachesTheCaller) {
  for (int threads : kThreads) {
    const ExecutionScope limit({.threads = threads});
    EXPECT_THROW(parallel_tasks({[] {}, [] { throw UsageError("second task"); }, [] {}}), UsageError);
  }
}

TEST(ParallelTasks, MayRunLoopsInside) {
  std::atomic<std::size_t> sum = 0;
  const auto loop = [&] { parallel_chunks(100, 3, [&](std::size_t begin, std::size_t end) { sum += end - begin; }); };
  parallel_tasks({loop, loop, loop});
  EXPECT_EQ(sum, 300u);
}

/// Terms of very different size, so that every order of additions rounds differently.
double term(std::size_t i) {
  const double x = static_cast<double>(i);
  return std::sin(x) * std::exp(std::fmod(x, 30.0));
}

double chunk_sum(std::size_t begin, std::size_t end) {
  double sum = 0.0;
  for (std::size_t i = begin; i < end; ++i) sum += term(i);
  return sum;
}

TEST(OrderedSum, IsBitwiseTheSameForAnyNumberOfThreads) {
  constexpr std::size_t kN = 10'001, kChunk = 50;
  double forward = 0.0, backward = 0.0;
  for (std::size_t begin = 0; begin < kN; begin += kChunk) forward += chunk_sum(begin, std::min(kN, begin + kChunk));
  for (std::size_t c = (kN - 1) / kChunk + 1; c-- > 0;)
    backward += chunk_sum(c * kChunk, std::min(kN, (c + 1) * kChunk));
  ASSERT_NE(forward, backward) << "these terms cannot tell one order from another";
  for (int threads : kThreads) {
    const ExecutionScope limit({.threads = threads});
    const double sum = ordered_sum<double>(kN, kChunk, [](std::size_t begin, std::size_t end) {
      // Chunks of uneven length finish out of order.
      if (begin / kChunk % 7 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
      return chunk_sum(begin, end);
    });
    EXPECT_EQ(std::bit_cast<std::uint64_t>(sum), std::bit_cast<std::uint64_t>(forward)) << threads << " threads";
  }
}

TEST(OrderedSum, OfNothingIsTheDefaultValue) {
  EXPECT_EQ(ordered_sum<double>(0, 10, [](std::size_t, std::size_t) { return 1.0; }), 0.0);
}

TEST(OrderedSum, TakesAnyTypeThatAdds) {
  struct Moments {
    std::size_t n = 0;
    std::size_t sum = 0;
    Moments& operator+=(const Moments& other) {
      n += other.n;
      sum += other.sum;
      return *this;
    }
  };
  const auto moments = ordered_sum<Moments>(101, 8, [](std::size_t begin, std::size_t end) {
    Moments m;
    for (std::size_t i = begin; i < end; ++i) m += Moments{1, i};
    return m;
  });
  EXPECT_EQ(moments.n, 101u);
  EXPECT_EQ(moments.sum, 5050u);
}

}  // namespace parallel_test
}  // namespace cmap
