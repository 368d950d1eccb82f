#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

namespace cmap {

/// Receives what long work is doing: the stage's name and the share of the whole that is done, in [0,1].
using ProgressSink = std::function<void(std::string_view stage, double done)>;

/// A progress bar on stderr, shown only on a terminal and only once the work has taken over a second.
/// Not thread-safe: report from the thread that runs the stages.
class ProgressBar {
 public:
  /// `enabled` false silences it (--quiet).
  explicit ProgressBar(bool enabled);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::string_view stage, double done);

 private:
  bool enabled_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The line that the bar prints, without control characters: "[#####     ]  50 %  nearest neighbors".
std::string progress_line(std::string_view stage, double done);

}  // namespace cmap
