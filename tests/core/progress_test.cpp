#include "cmap/core/progress.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace cmap {
namespace progress_test {

TEST(ProgressLine, ShowsBarPercentageAndStage) {
  EXPECT_EQ(progress_line("reading", 0.0), "[                              ]   0 %  reading");
  EXPECT_EQ(progress_line("nearest neighbors", 0.5), "[###############               ]  50 %  nearest neighbors");
  EXPECT_EQ(progress_line("writing", 1.0), "[##############################] 100 %  writing");
}

TEST(ProgressLine, IsFullOnlyWhenDone) {
  const std::string line = progress_line("", 0.99);
  EXPECT_EQ(std::count(line.begin(), line.end(), '#'), 29);
  EXPECT_NE(line.find(" 99 %"), std::string::npos) << line;
}

TEST(ProgressLine, OnlyGrows) {
  std::ptrdiff_t before = 0;
  for (int percent = 0; percent <= 100; ++percent) {
    const std::string line = progress_line("stage", percent / 100.0);
    EXPECT_EQ(line.size(), progress_line("stage", 0.0).size()) << "the line must not move";
    const std::ptrdiff_t marks = std::count(line.begin(), line.end(), '#');
    EXPECT_GE(marks, before);
    before = marks;
  }
  EXPECT_EQ(before, 30);
}

TEST(ProgressLine, TheBarStaysInItsBracketsOutsideZeroToOne) {
  for (double done : {-0.5, 1.5}) {
    const std::string line = progress_line("stage", done);
    EXPECT_EQ(line.find(']'), 31u) << line;
  }
}

TEST(ProgressBar, IsSilentWhereStderrIsNoTerminal) {
  testing::internal::CaptureStderr();  // a file
  {
    ProgressBar bar(true);
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));  // longer than the second without a bar
    bar.update("stage", 0.5);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace progress_test
}  // namespace cmap
