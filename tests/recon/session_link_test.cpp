#include "cmap/recon/session_link.hpp"

#include <gtest/gtest.h>

#include "recon/session_testing.hpp"

namespace cmap {
namespace session_link_test {

using test::at;
using test::session_of;

std::variant<SessionLink, NotLinked> linked(const LinkedSession& a, const LinkedSession& b) {
  return link_sessions(a, b, PointSource::kDepth, 1e-4, 0.2, {});
}

std::string refusal(const LinkedSession& a, const LinkedSession& b) {
  const auto found = linked(a, b);
  return std::holds_alternative<NotLinked>(found) ? std::get<NotLinked>(found).reason : "linked";
}

/// Two sessions of different units; the second is displaced by a known motion: the link brings it back.
TEST(SessionLink, ALinkFindsTheMotionBetweenSessions) {
  const SessionPredictions a = session_of(0, 6, 2.0), b = session_of(4, 6, 0.5);
  const PlacedSession placed_a = placed_session(0, frames_of(a), at(2.0, {0, 0, 0}, 0.0), 0.1);
  const Similarity truth = at(0.5, {4, 0, 0}, 0.0);
  const Similarity error = at(1.0, {0.15, -0.1, 0.08}, 0.01);
  const PlacedSession placed_b = placed_session(1, frames_of(b), error * truth, 0.1);
  const auto found = linked({a, placed_a, 1.5}, {b, placed_b, 1.5});
  ASSERT_TRUE(std::holds_alternative<SessionLink>(found)) << std::get<NotLinked>(found).reason;
  const auto* link = &std::get<SessionLink>(found);
  EXPECT_EQ(a.frames[link->from_frame].time_s, b.frames[link->to_frame].time_s);
  // One camera, seen by both: the identity. Depths are floats of 10 m, and ICP's thinned points of one surface agree
  // to a small part of their 0.2 m voxel.
  EXPECT_LT(link->T_from_to.translation().norm(), 0.01);
  EXPECT_LT(Eigen::AngleAxisd(link->T_from_to.linear()).angle(), 0.002);
}

TEST(SessionLink, SessionsApartHaveNoLink) {
  const SessionPredictions a = session_of(0, 3, 1.0), b = session_of(7, 3, 1.0);
  const PlacedSession placed_a = placed_session(0, frames_of(a), {}, 0.1),
                      placed_b = placed_session(1, frames_of(b), {}, 0.1);
  EXPECT_EQ(refusal({a, placed_a, 1.5}, {b, placed_b, 1.5}), "no frame is shared");
  EXPECT_EQ(refusal({a, placed_a, 99.0}, {a, placed_a, 99.0}), "0 pixels of shared frames are good in both");
}

}  // namespace session_link_test
}  // namespace cmap
