#include "worker.hpp"

#include <utility>

#include "cmap/core/execution.hpp"
#include "cmap/core/parallel.hpp"

namespace cmap {

Worker::Worker()
    : thread_([this, threads = thread_count()] {
        const ExecutionScope as_the_caller({.threads = threads});
        work();
      }) {}

Worker::~Worker() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Worker::run(const std::function<void()>& task) {
  std::unique_lock lock(mutex_);
  task_ = &task;
  changed_.notify_all();
  changed_.wait(lock, [this] { return task_ == nullptr; });
  if (failure_ != nullptr) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Worker::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_over_ || task_ != nullptr; });
    if (is_over_) return;
    try {
      (*task_)();
    } catch (...) {
      failure_ = std::current_exception();
    }
    task_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace cmap
