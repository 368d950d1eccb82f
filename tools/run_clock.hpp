#pragma once

// When a run of an evaluation began, how long its stages take, and what is told of them on the way.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <string>

#include "cmap/core/parallel.hpp"
#include "cmap/core/progress.hpp"
#include "cmap/core/simd.hpp"
#include "cmap/report/report.hpp"

namespace cmap {

class RunClock {
 public:
  RunClock(const std::string& command, bool quiet) : progress_(!quiet) {
    const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    run_.command = command;
    run_.started_utc = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
    run_.threads = thread_count();
    run_.simd = simd_level_name(simd_level());
  }

  /// Reads what the evaluation begins with.
  template <class Read>
  auto timed_reading(Read&& read) {
    progress_.update("read", 0.0);
    auto maps = read();
    run_.stage_seconds.emplace_back("read", seconds());
    return maps;
  }

  ProgressSink progress() {
    return [this](std::string_view stage, double done) { progress_.update(stage, done); };
  }

  /// The run up to here, with the stages of the evaluation.
  template <class Evaluated>
  RunDescription description_after(const Evaluated& evaluation) const {
    RunDescription run = run_;
    run.stage_seconds.insert(run.stage_seconds.end(), evaluation.stage_seconds.begin(), evaluation.stage_seconds.end());
    run.wall_s = seconds();
    return run;
  }

 private:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  RunDescription run_;
  ProgressBar progress_;
};

}  // namespace cmap
