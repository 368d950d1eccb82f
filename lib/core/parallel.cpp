#include "cmap/core/parallel.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

namespace cmap {
namespace {
std::unique_ptr<tbb::global_control> thread_limit;
}

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) {
    thread_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                         static_cast<std::size_t>(threads));
  }
}

ThreadLimit::~ThreadLimit() { thread_limit.reset(); }

int thread_count() {
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::min(tbb::this_task_arena::max_concurrency(), static_cast<int>(allowed));
}

void parallel_chunks(std::size_t n, std::size_t chunk_size,
                     const std::function<void(std::size_t begin, std::size_t end)>& body) {
  const std::size_t n_chunks = (n + chunk_size - 1) / chunk_size;
  const auto one = [&](std::size_t chunk) { body(chunk * chunk_size, std::min(n, (chunk + 1) * chunk_size)); };
  if (thread_count() == 1) {
    for (std::size_t chunk = 0; chunk < n_chunks; ++chunk) one(chunk);
    return;
  }
  tbb::parallel_for(std::size_t{0}, n_chunks, one, tbb::simple_partitioner());
}

void parallel_tasks(const std::vector<std::function<void()>>& tasks) {
  tbb::parallel_for(
      std::size_t{0}, tasks.size(), [&](std::size_t i) { tasks[i](); }, tbb::simple_partitioner());
}

}  // namespace cmap
