#pragma once

#include <memory>
#include <stop_token>
#include <string_view>

#include "cmap/core/progress.hpp"

namespace cmap {

/// How a long call runs; what it finds does not depend on it. Calls of several threads do not disturb each other.
struct Execution {
  /// Of its parallel loops, at most what the machine has; 0: as many as the caller's, all outside of any.
  int threads = 0;
  /// Once requested, the call throws Interrupted at its next chunk and leaves nothing behind; a stop of the call around
  /// it counts, too. Programs need none: signals end them by themselves (cmap/io/stop_signals.hpp).
  std::stop_token stop = {};
  /// Gets the stages of this call, not those of calls inside it, from the thread that called.
  ProgressSink progress = {};
};

struct ExecutionState;

/// For as long as it lives, what its thread runs, with the tasks of its parallel loops, runs so. Nests.
class ExecutionScope {
 public:
  explicit ExecutionScope(Execution execution);
  ~ExecutionScope();
  ExecutionScope(const ExecutionScope&) = delete;
  ExecutionScope& operator=(const ExecutionScope&) = delete;

 private:
  std::unique_ptr<ExecutionState> state_;
};

/// For long loops, once a chunk; parallel ones do it themselves. Throws Interrupted where a stop was requested.
void throw_if_stopped();

/// Tells the scope's sink, from the thread that opened the scope. Throws Interrupted where a stop was requested.
void report_progress(std::string_view stage, double done);

}  // namespace cmap
