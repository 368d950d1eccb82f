#include "recordings/messages/point_times.hpp"

#include "cmap/core/error.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace point_times_test {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

std::vector<double> offsets(std::vector<double> values, ScalarType type, std::string_view field = "time",
                            double stamp_s = 1.6e9, PointTimeUnit unit = PointTimeUnit::kAuto) {
  PointTimes(unit).to_offsets(values, field, type, static_cast<std::int64_t>(stamp_s * 1e9));
  return values;
}

auto are(double a, double b, double within = 1e-12) {
  return ElementsAre(DoubleNear(a, within), DoubleNear(b, within));
}

TEST(PointTimes, FloatingPointNumbersInTheUnitThatMakesThemTimesOfAScan) {
  EXPECT_THAT(offsets({-0.1002, 0.0006}, ScalarType::kFloat32), are(-0.1002, 0.0006));
  EXPECT_THAT(offsets({0.0, 99.5}, ScalarType::kFloat32), are(0.0, 0.0995));
  EXPECT_THAT(offsets({0.0, 99500.0}, ScalarType::kFloat32), are(0.0, 0.0995));
  EXPECT_THAT(offsets({0.0, 9.95e7}, ScalarType::kFloat32), are(0.0, 0.0995));
}

TEST(PointTimes, WholeNumbersInNanosecondsUnlessTheirNameSaysOtherwise) {
  EXPECT_THAT(offsets({0.0, 99500.0}, ScalarType::kUint32, "t"), are(0.0, 9.95e-5));
  EXPECT_THAT(offsets({0.0, 99500.0}, ScalarType::kUint32, "t_us"), are(0.0, 0.0995));
  EXPECT_THAT(offsets({0.0, 99500.0}, ScalarType::kUint32, "t", 1.6e9, PointTimeUnit::kMicroseconds), are(0.0, 0.0995));
}

TEST(PointTimes, TimesOfTheClockInAnyUnit) {
  for (const double unit : {1.0, 1e3, 1e6, 1e9}) {
    const double within = 3e-7;  // what doubles hold of such times
    EXPECT_THAT(offsets({1.6e9 * unit, (1.6e9 + 0.0625) * unit}, ScalarType::kFloat64, "timestamp"),
                are(0.0, 0.0625, within));
    // A sensor without synchronization counts from its start.
    EXPECT_THAT(offsets({100.0 * unit, 100.0625 * unit}, ScalarType::kFloat64, "timestamp", 100.0),
                are(0.0, 0.0625, within));
  }
  EXPECT_THAT(offsets({0.0, 0.0625}, ScalarType::kFloat64, "timestamp"), are(0.0, 0.0625)) << "offsets in doubles";
}

TEST(PointTimes, WhatAMessageIsFilledUpWithHasNoTime) {
  const std::vector<double> found = offsets({0.0, 1.6e9}, ScalarType::kFloat64, "timestamp");
  EXPECT_TRUE(std::isnan(found[0]));
  EXPECT_EQ(found[1], 0.0);
}

TEST(PointTimes, WhatAScanShowedStays) {
  PointTimes times;
  std::vector<double> zeros{0.0, 0.0}, first{0.0, 99500.0}, second{0.0, 2.0};
  times.to_offsets(zeros, "time", ScalarType::kFloat32, 0);
  times.to_offsets(first, "time", ScalarType::kFloat32, 0);
  times.to_offsets(second, "time", ScalarType::kFloat32, 0);
  EXPECT_THAT(second, are(0.0, 2e-6)) << "microseconds, though two could be seconds";
}

TEST(PointTimes, TimesOfNoScanAreRefused) {
  EXPECT_THROW(offsets({0.0, 1e12}, ScalarType::kFloat32), InputError);
  EXPECT_THROW(offsets({0.0, 99500.0}, ScalarType::kFloat32, "time", 1.6e9, PointTimeUnit::kSeconds), InputError);
  EXPECT_THROW(offsets({1.5e18, 1.5e18}, ScalarType::kFloat64, "timestamp"), InputError) << "of another clock";
}

}  // namespace point_times_test
}  // namespace cmap::testing
