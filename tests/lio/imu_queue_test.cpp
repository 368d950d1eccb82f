#include "odometry/imu_queue.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace cmap {
namespace imu_queue_test {

using Eigen::Vector3d;

constexpr double kMaxGap_s = 0.05;

/// Rates along x and forces along z grow linearly in time.
ImuSample sample(double t) { return {t, Vector3d(10.0 * t, 0.0, 0.0), Vector3d(0.0, 0.0, 100.0 * t)}; }

ImuQueue queue_of(const std::vector<double>& times) {
  ImuQueue queue(kMaxGap_s);
  for (const double t : times) queue.add(sample(t));
  return queue;
}

double total_s(const std::vector<MotionInput>& steps) {
  double sum = 0.0;
  for (const MotionInput& step : steps) sum += step.duration_s;
  return sum;
}

void expect_step(const MotionInput& step, double from_s, double to_s) {
  EXPECT_NEAR(step.duration_s, to_s - from_s, 1e-12);
  EXPECT_NEAR(step.rate_radps.x(), 5.0 * (from_s + to_s), 1e-9) << "the mean";
  EXPECT_NEAR(step.force_mps2.z(), 50.0 * (from_s + to_s), 1e-9);
  EXPECT_TRUE(step.rate_measured);
  EXPECT_TRUE(step.force_measured);
}

TEST(ImuQueue, StepsGoFromSampleToSample) {
  const auto steps = queue_of({0.0, 0.01, 0.02, 0.03}).inputs(0.0, 0.03);
  ASSERT_EQ(steps.size(), 3U);
  for (int i = 0; i < 3; ++i) expect_step(steps[static_cast<std::size_t>(i)], 0.01 * i, 0.01 * (i + 1));
}

TEST(ImuQueue, StepsBeginAndEndBetweenSamples) {
  const ImuQueue queue = queue_of({0.0, 0.01, 0.02, 0.03});
  const auto steps = queue.inputs(0.0025, 0.0225);
  ASSERT_EQ(steps.size(), 3U);
  expect_step(steps[0], 0.0025, 0.01);
  expect_step(steps[1], 0.01, 0.02);
  expect_step(steps[2], 0.02, 0.0225);
  const auto within_one = queue.inputs(0.012, 0.016);
  ASSERT_EQ(within_one.size(), 1U);
  expect_step(within_one[0], 0.012, 0.016);
}

TEST(ImuQueue, StepsAddUpWhateverTheSamples) {
  const ImuQueue queue = queue_of({0.0, 0.004, 0.03, 0.031, 0.2, 0.21});
  for (const auto& [from, to] : std::vector<std::pair<double, double>>{
           {-0.3, -0.1}, {-0.1, 0.002}, {0.0, 0.21}, {0.003, 0.19}, {0.05, 0.1}, {0.1, 0.5}, {0.3, 0.4}, {-1.0, 1.0}}) {
    EXPECT_NEAR(total_s(queue.inputs(from, to)), to - from, 1e-12) << from << " to " << to;
  }
  EXPECT_TRUE(queue.inputs(0.1, 0.1).empty());
}

TEST(ImuQueue, SamplesOutOfOrderAreRefused) {
  ImuQueue queue(kMaxGap_s);
  EXPECT_TRUE(queue.add(sample(0.01)));
  EXPECT_FALSE(queue.add(sample(0.01))) << "twice";
  EXPECT_FALSE(queue.add(sample(0.005))) << "late";
  EXPECT_TRUE(queue.add(sample(0.02)));
  EXPECT_EQ(queue.between(0.0, 1.0).size(), 2U);
  EXPECT_EQ(queue.n_gaps(), 0U);
}

TEST(ImuQueue, GapsAreGuessedWithTheLastRate) {
  const ImuQueue queue = queue_of({0.0, 0.01, 0.09, 0.1});
  EXPECT_EQ(queue.n_gaps(), 1U);
  const auto steps = queue.inputs(0.0, 0.1);
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_TRUE(steps[0].rate_measured);
  EXPECT_FALSE(steps[1].rate_measured);
  EXPECT_FALSE(steps[1].force_measured);
  EXPECT_NEAR(steps[1].duration_s, 0.08, 1e-12);
  EXPECT_NEAR(steps[1].rate_radps.x(), 0.1, 1e-12);
  EXPECT_TRUE(steps[2].rate_measured);
}

TEST(ImuQueue, AGapAsLongAsAllowedIsNone) {
  const ImuQueue queue = queue_of({0.0, 0.05});
  EXPECT_EQ(queue.n_gaps(), 0U);
  const auto steps = queue.inputs(0.0, 0.05);
  ASSERT_EQ(steps.size(), 1U);
  expect_step(steps[0], 0.0, 0.05);
}

TEST(ImuQueue, BeforeTheFirstAndAfterTheLastIsGuessed) {
  const ImuQueue queue = queue_of({0.1, 0.11});
  const auto before = queue.inputs(0.05, 0.1);
  ASSERT_EQ(before.size(), 1U);
  EXPECT_FALSE(before[0].rate_measured);
  EXPECT_NEAR(before[0].rate_radps.x(), 1.0, 1e-12) << "the first";
  const auto after = queue.inputs(0.11, 0.16);
  ASSERT_EQ(after.size(), 1U);
  EXPECT_FALSE(after[0].force_measured);
  EXPECT_NEAR(after[0].rate_radps.x(), 1.1, 1e-12) << "the last";
}

TEST(ImuQueue, WithoutSamplesStandsStill) {
  const auto steps = ImuQueue(kMaxGap_s).inputs(1.0, 1.5);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].rate_radps, Vector3d(Vector3d::Zero()));
  EXPECT_FALSE(steps[0].rate_measured);
}

TEST(ImuQueue, ForgetsWhatLaterTimesDoNotNeed) {
  ImuQueue queue = queue_of({0.0, 0.01, 0.02, 0.03});
  const auto expected = queue.inputs(0.015, 0.03);
  queue.forget_before(0.015);
  EXPECT_EQ(queue.first_s(), 0.01) << "the one before is needed";
  const auto found = queue.inputs(0.015, 0.03);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].rate_radps, expected[i].rate_radps);
  queue.forget_before(1.0);
  EXPECT_EQ(queue.first_s(), 0.03) << "the last stays";
  EXPECT_FALSE(queue.add(sample(0.03)));
}

}  // namespace imu_queue_test
}  // namespace cmap
