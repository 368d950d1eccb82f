#pragma once

#include <functional>
#include <stdexcept>

namespace cmap {

/// Why a piece of work has no result: its own failure, which stops no other.
struct WorkFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `work` in a process of its own and waits: neither a crash nor the system's lack of memory ends this process,
/// and what the work held is given back. It ends with this process, even where that is killed. What it changes in
/// memory is lost. Throws UsageError, OutputError and Interrupted where the work throws them, WorkFailure where it
/// throws anything else or dies. A stop that is requested of this process ends the other. This
/// process must not have started threads.
void run_apart(const std::function<void()>& work);

}  // namespace cmap
