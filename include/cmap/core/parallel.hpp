#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace cmap {

/// Threads that parallel loops use now; cmap/core/execution.hpp says how many.
int thread_count();

/// Calls body(begin, end) for consecutive chunks of [0, n) in parallel. The chunks depend on `chunk_size` alone, never
/// on the number of threads; exceptions of the body reach the caller, as does Interrupted (cmap/core/execution.hpp).
void parallel_chunks(std::size_t n, std::size_t chunk_size,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Runs independent tasks in parallel and waits; an exception of a task reaches the caller.
void parallel_tasks(const std::vector<std::function<void()>>& tasks);

/// Sums chunk results in order of the chunks: bitwise the same for any number of threads.
/// chunk_result(begin, end) returns a Sum; Sum needs a default value and operator+=.
template <class Sum, class ChunkResult>
Sum ordered_sum(std::size_t n, std::size_t chunk_size, ChunkResult&& chunk_result) {
  std::vector<Sum> partial((n + chunk_size - 1) / chunk_size);
  parallel_chunks(n, chunk_size,
                  [&](std::size_t begin, std::size_t end) { partial[begin / chunk_size] = chunk_result(begin, end); });
  Sum total{};
  for (const Sum& p : partial) total += p;
  return total;
}

/// Chunk of element-wise loops: large enough to hide the scheduling, small enough to balance.
inline constexpr std::size_t kLoopChunk = std::size_t{1} << 16;

}  // namespace cmap
