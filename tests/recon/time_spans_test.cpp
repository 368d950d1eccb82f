#include "sessions/time_spans.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cmap {
namespace time_spans_test {

using ::testing::HasSubstr;

Trajectory poses_at(std::initializer_list<double> times_s) {
  Trajectory poses;
  for (const double time_s : times_s)
    poses.push_back({time_s, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()});
  return poses;
}

std::string text(std::vector<double> frame_times_s, std::initializer_list<double> pose_times_s) {
  return no_common_time(frame_times_s, poses_at(pose_times_s), 0.15);
}

TEST(TimeSpans, NamesBothSpansAndTheGap) {
  const std::string message = text({10.5, 11, 12.25}, {1, 2, 3.5});
  EXPECT_THAT(message, HasSubstr("the frames are from 10.500 to 12.250 s, the poses from 1.000 to 3.500 s"));
  EXPECT_THAT(message, HasSubstr("gaps of at most 0.15 s allowed between poses (max_gap_s)"));
  EXPECT_THAT(message, HasSubstr("; time_offset.image_s of capture.json tells of another clock"));
}

TEST(TimeSpans, TimesSince1970KeepTheirDigits) {
  EXPECT_THAT(text({1317042504.967931}, {1317042600.25}),
              HasSubstr("from 1317042504.968 to 1317042504.968 s, the poses from 1317042600.250 to"));
}

TEST(TimeSpans, PosesTooFarApart) {
  EXPECT_THAT(text({10.5, 11.5}, {10, 11, 12}),
              HasSubstr("the poses from 10.000 to 12.000 s, 1 s or more apart around the frames; at most 0.15 s are"));
}

TEST(TimeSpans, UnitsAreGuessed) {
  EXPECT_THAT(text({1.317e18, 1.3170001e18}, {1.317e9}), HasSubstr("; are those of the frames nanoseconds?"));
  EXPECT_THAT(text({10, 20}, {10000.0, 21000.0}), HasSubstr("; are those of the poses milliseconds?"));
}

}  // namespace time_spans_test
}  // namespace cmap
