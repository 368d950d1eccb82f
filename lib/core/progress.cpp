#include "cmap/core/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace cmap {

ProgressBar::ProgressBar(bool enabled) : enabled_(enabled && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::update(std::string_view stage, double done) {
  if (!enabled_ || std::chrono::steady_clock::now() - start_ < std::chrono::seconds(1)) return;
  shown_ = true;
  fmt::print(stderr, "\r\033[K{}", progress_line(stage, done));
  std::fflush(stderr);
}

std::string progress_line(std::string_view stage, double done) {
  constexpr int kWidth = 30;
  const int filled = std::clamp(static_cast<int>(done * kWidth), 0, kWidth);
  return fmt::format("[{:<{}}] {:3.0f} %  {}", std::string(static_cast<std::size_t>(filled), '#'), kWidth, 100.0 * done,
                     stage);
}

}  // namespace cmap
