#include "cmap/colorize/posed_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmap/core/error.hpp"

namespace cmap {
namespace posed_images_test {

using ::testing::HasSubstr;

/// Images at 0, 0.1, ... 0.9 s; along x at 10 m/s from 0.15 to 0.75 s.
Capture drive() {
  Capture capture;
  capture.folder = "drive";
  for (int i = 0; i < 10; ++i) capture.images.push_back({0.1 * i, "images/" + std::to_string(i) + ".jpg"});
  for (int i = 0; i <= 6; ++i) {
    const double t = 0.15 + 0.1 * i;
    capture.lio.push_back({t, {10 * t, 0, 0}, Eigen::Quaterniond::Identity()});
  }
  capture.calibration.T_imu_lidar.translation() << 0, 0, 1;
  return capture;
}

template <class Wrong, class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const Wrong& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(PosedImages, ThoseWithAPoseAndHowManyHaveNone) {
  const Capture capture = drive();
  const PosedCapture all = posed_images(capture, capture.lio, {});
  ASSERT_EQ(all.images.list.size(), 6u);  // 0.2 to 0.7 s
  EXPECT_EQ(all.n_chosen, 10u);
  EXPECT_EQ(all.n_without_pose, 4u);
  EXPECT_EQ(all.images.list[0].index, 2u);
  EXPECT_EQ(all.images.list[0].name, "2.jpg");
  EXPECT_LT((all.images.list[0].T_world_lidar.translation() - Eigen::Vector3d(2, 0, 1)).norm(), 1e-9);
}

TEST(PosedImages, EvenAndOddOnesShareNone) {
  const Capture capture = drive();
  const PosedCapture even = posed_images(capture, capture.lio, {.subset = {2, 0}});
  const PosedCapture odd = posed_images(capture, capture.lio, {.subset = {2, 1}});
  EXPECT_EQ(even.n_chosen + odd.n_chosen, 10u);
  for (const PosedImage& image : even.images.list) EXPECT_EQ(image.index % 2, 0u);
  for (const PosedImage& image : odd.images.list) EXPECT_EQ(image.index % 2, 1u);
}

TEST(PosedImages, AnOffsetMovesTheirTimes) {
  const Capture capture = drive();
  const PosedCapture later = posed_images(capture, capture.lio, {.time_offset_s = 0.05});
  EXPECT_NEAR(later.images.list[0].time_s, 0.15, 1e-9);
  EXPECT_NEAR(later.images.list[0].T_world_lidar.translation().x(), 1.5, 1e-6);
}

TEST(PosedImages, SayWhatIsMissing) {
  const Capture capture = drive();
  EXPECT_THAT(message_of<InputError>([&] { posed_images(capture, capture.lio, {.time_offset_s = 100}); }),
              HasSubstr("drive: no image has a pose at its time: images from 0.000 to 0.900 s and +100 s, poses from"));
  EXPECT_THAT(message_of<InputError>([&] { posed_images(capture, {}, {}); }), HasSubstr("no poses"));
  Capture none = capture;
  none.images.clear();
  EXPECT_THAT(message_of<InputError>([&] { posed_images(none, capture.lio, {}); }), HasSubstr("drive: no images"));
  EXPECT_THROW(posed_images(capture, capture.lio, {.subset = {0, 0}}), UsageError);
  EXPECT_THROW(posed_images(capture, capture.lio, {.subset = {2, 10}}), UsageError);
}

}  // namespace posed_images_test
}  // namespace cmap
