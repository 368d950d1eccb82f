#include "cmap/recon/session_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmap/core/error.hpp"

namespace cmap {
namespace session_points_test {

/// One row of pixels with these confidences, seen by a camera at the session's origin.
SessionPredictions row_of(std::vector<float> confidences) {
  SessionPredictions session;
  session.width = static_cast<int>(confidences.size());
  session.height = 1;
  session.frames.resize(1);
  session.T_camera_session.resize(1, Eigen::Isometry3d::Identity());
  session.intrinsics.assign(1, Eigen::Matrix3d::Identity());
  session.depth.assign(confidences.size(), 2.0F);
  session.images.assign(confidences.size(), Rgb8{1, 2, 3});
  session.depth_confidence.assign(confidences.begin(), confidences.end());
  return session;
}

double threshold(std::vector<float> confidences, const ConfidenceCut& cut = {}) {
  return confidence_threshold(row_of(std::move(confidences)), cut, PointSource::kDepth);
}

TEST(ConfidenceThreshold, DropsTheLowestFifth) {
  EXPECT_EQ(threshold({9, 3, 5, 8, 2, 6, 7, 4, 10, 11}), 4.0) << "two of ten";
  EXPECT_EQ(threshold({9, 3, 5, 8}), 3.0) << "a fifth of four is none";
  EXPECT_EQ(threshold({9, 3, 5, 8}, {.lowest_share = 0.5}), 8.0);
  EXPECT_EQ(threshold({9, 3, 5, 8}, {.lowest_share = 0.0}), 3.0);
}

TEST(ConfidenceThreshold, SkyDoesNotUseUpTheShare) {
  EXPECT_EQ(threshold({9, 3, 5, 8, 2, 6, 7, 4, 10, 11, 1, 1, 1, 1, 1, 1, 0, 0}), 4.0);
  EXPECT_EQ(threshold({1.4F, 1.5F, 1.6F, 1.7F}), 1.5) << "the floor itself counts";
}

TEST(ConfidenceThreshold, SaysWhereNothingIsLeft) {
  EXPECT_THROW(threshold({1, 1, 1}), UnsupportedError);
  EXPECT_THROW(threshold({9, 3}, {.lowest_share = 1.0}), UnsupportedError);
  EXPECT_THROW(confidence_threshold(row_of({9, 3}), {}, PointSource::kHead), UsageError) << "no world_points";
}

TEST(FramePointsOf, ArePixelsWithEnoughConfidenceInTheCamerasFrame) {
  const SessionPredictions session = row_of({9, 1, 0, 5});
  const FramePoints points = frame_points(session, 0, 5.0, PointSource::kDepth);
  EXPECT_THAT(points.pixel, ::testing::ElementsAre(0U, 3U));
  ASSERT_EQ(points.positions.size(), 2U);
  EXPECT_EQ(points.positions[1], Eigen::Vector3f(6, 0, 2)) << "K is the identity: (u, v, 1) times the depth";
  EXPECT_EQ(points.confidence[1], 5.0F);
  EXPECT_EQ(points.colors[1], (Rgb8{1, 2, 3}));
}

}  // namespace session_points_test
}  // namespace cmap
