#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "cmap/core/execution.hpp"

namespace cmap {

/// Times the stages of an evaluation and tells the user which one runs.
class StageClock {
 public:
  explicit StageClock(std::vector<std::pair<std::string, double>>& seconds) : seconds_(seconds) {}

  template <class Work>
  void run(const char* stage, double done_before, Work&& work) {
    report_progress(stage, done_before);
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds_.emplace_back(stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

 private:
  std::vector<std::pair<std::string, double>>& seconds_;
};

}  // namespace cmap
