#include "cmap/core/parallel.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "cmap/core/execution.hpp"
#include "execution_state.hpp"

namespace cmap {
namespace {

/// What a task of a loop runs in: the scope of the loop, on whatever thread.
class InScope {
 public:
  explicit InScope(ExecutionState* scope) : current_(current_execution()), before_(current_) { current_ = scope; }
  ~InScope() { current_ = before_; }
  InScope(const InScope&) = delete;
  InScope& operator=(const InScope&) = delete;

 private:
  ExecutionState*& current_;
  ExecutionState* before_;
};

/// Calls task(i) for i in [0, n) in parallel, and asks before each whether to stop.
template <class Task>
void for_each(std::size_t n, const Task& task) {
  ExecutionState* const scope = current_execution();
  const auto one = [&](std::size_t i) {
    const InScope same(scope);
    throw_if_stopped();
    task(i);
  };
  const auto all = [&] { tbb::parallel_for(std::size_t{0}, n, one, tbb::simple_partitioner()); };
  if (thread_count() == 1) {
    for (std::size_t i = 0; i < n; ++i) one(i);
  } else if (scope != nullptr && scope->arena != nullptr) {
    scope->arena->execute(all);
  } else {
    all();
  }
}

}  // namespace

int thread_count() {
  const ExecutionState* scope = current_execution();
  return scope != nullptr ? scope->threads : tbb::this_task_arena::max_concurrency();
}

void parallel_chunks(std::size_t n, std::size_t chunk_size,
                     const std::function<void(std::size_t begin, std::size_t end)>& body) {
  for_each((n + chunk_size - 1) / chunk_size,
           [&](std::size_t chunk) { body(chunk * chunk_size, std::min(n, (chunk + 1) * chunk_size)); });
}

void parallel_tasks(const std::vector<std::function<void()>>& tasks) {
  for_each(tasks.size(), [&](std::size_t i) { tasks[i](); });
}

}  // namespace cmap
