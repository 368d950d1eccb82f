#include "cmap/core/execution.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "execution_state.hpp"
#include "host_settings.hpp"

namespace cmap {
namespace {

ExecutionState*& own_execution() {
  thread_local ExecutionState* current = nullptr;
  return current;
}

std::atomic<ExecutionState*& (*)()> current_of_thread = own_execution;

}  // namespace

ExecutionState*& current_execution() { return current_of_thread.load(std::memory_order_relaxed)(); }

void take_execution_from(ExecutionState*& (*current)()) { current_of_thread = current; }

ExecutionScope::ExecutionScope(Execution execution) {
  ExecutionState* outer = current_execution();
  state_ = std::make_unique<ExecutionState>(ExecutionState{std::move(execution), outer, thread_count()});
  if (outer != nullptr) state_->arena = outer->arena;
  if (const int asked = state_->execution.threads; asked > 0) {
    state_->threads = std::min(asked, tbb::info::default_concurrency());
    state_->arena = &state_->own.emplace(state_->threads);
  }
  current_execution() = state_.get();
}

ExecutionScope::~ExecutionScope() { current_execution() = state_->outer; }

void throw_if_stopped() {
  for (const ExecutionState* scope = current_execution(); scope != nullptr; scope = scope->outer) {
    if (scope->execution.stop.stop_requested()) throw Interrupted();
  }
}

void report_progress(std::string_view stage, double done) {
  const ExecutionState* scope = current_execution();
  if (scope != nullptr && scope->execution.progress) scope->execution.progress(stage, done);
  throw_if_stopped();
}

}  // namespace cmap
