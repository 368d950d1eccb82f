#pragma once

#include <tbb/task_arena.h>

#include <optional>

#include "cmap/core/execution.hpp"

namespace cmap {

struct ExecutionState {
  Execution execution;
  ExecutionState* outer;                 ///< of the scope around it
  int threads;                           ///< at most; what execution.threads comes to
  std::optional<tbb::task_arena> own{};  ///< where it asks for threads of its own
  tbb::task_arena* arena = nullptr;      ///< own, or that of the scope around it; null: the thread's implicit one
};

/// Of the innermost scope on this thread; null outside of any.
ExecutionState*& current_execution();

}  // namespace cmap
