#include "recon/room_capture.hpp"
#include "registration/stage.hpp"

namespace cmap {
namespace registration_stage_test {

/// The sessions where they are.
std::vector<SessionState> placed_exactly() {
  std::vector<SessionState> sessions;
  for (std::size_t k = 0; k < test::kUnits_m.size(); ++k) {
    SessionState& state = sessions.emplace_back();
    state.outcome.index = k;
    state.outcome.name = fmt::format("session_{:04}", k);
    state.outcome.scale_prefusion = test::kUnits_m[k];
    state.outcome.prefusion_rmse_m = 0.1;
    const Eigen::Isometry3d start = test::room_camera_at(test::frame_time_s(k, 0));
    state.T_world_session = {test::kUnits_m[k], start.linear(), start.translation()};
    state.min_confidence = 1.5;
    state.placed = placed_session(k, frames_of(test::room_session(k)), state.T_world_session, 0.1);
  }
  return sessions;
}

std::vector<SessionState> displaced() {
  std::vector<SessionState> sessions = placed_exactly();
  Similarity error;
  error.scale = 1.01;
  error.translation << 0.1, -0.08, 0.05;
  for (SessionState& state : sessions) {
    state.T_world_session = error * state.T_world_session;
    state.placed = placed_session(state.outcome.index, frames_of(test::room_session(state.outcome.index)),
                                  state.T_world_session, 0.1);
  }
  return sessions;
}

TEST(RegistrationStage, MovesSessionsOntoTheLidar) {
  const test::RoomCapture room;
  const std::vector<SessionState> sessions = displaced();
  const RegistrationOut out = run_registration({room.open(), sessions}, {}, {});
  ASSERT_EQ(out.sessions.size(), sessions.size());
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    const SessionState& state = out.sessions[k];
    EXPECT_GT(test::camera_error_m(sessions[k].placed), 0.1);
    // Nearest neighbors of thinned clouds on walls, sampled 0.2 m apart.
    EXPECT_LT(test::camera_error_m(state.placed), 0.03) << k;
    EXPECT_NEAR(state.outcome.scale_registration * 1.01, 1.0, 0.005);
    EXPECT_GT(state.outcome.overlap, 0.95);
    EXPECT_TRUE(state.outcome.flags.empty());
  }
}

/// A shared frame is one camera: between its two poses there is nothing.
TEST(RegistrationStage, LinksNeighborsByTheirSharedFrames) {
  const test::RoomCapture room;
  const RegistrationOut out = run_registration({room.open(), placed_exactly()}, {}, {});
  ASSERT_EQ(out.links.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const SessionLink& link = out.links[k];
    EXPECT_EQ(link.from, k);
    EXPECT_EQ(link.to, k + 1);
    EXPECT_EQ(test::frame_time_s(k, link.from_frame), test::frame_time_s(k + 1, link.to_frame));
    EXPECT_LT(link.T_from_to.translation().norm(), 0.01);
    EXPECT_LT(Eigen::AngleAxisd(link.T_from_to.linear()).angle(), 0.002);
  }
}

TEST(RegistrationStage, DroppedSessionsAreNeitherMovedNorLinked) {
  const test::RoomCapture room;
  std::vector<SessionState> sessions = placed_exactly();
  sessions[1].outcome.dropped = "of no use";
  const RegistrationOut out = run_registration({room.open(), sessions}, {}, {});
  EXPECT_EQ(out.sessions[1].outcome.overlap, 0.0);
  EXPECT_TRUE(out.links.empty()) << "the first and the last share no frame";
  EXPECT_THAT(out.sessions[2].outcome.flags, ::testing::Contains("not linked to session_0000: no frame is shared"));
}

TEST(RegistrationStage, WithoutScansPrefusionStaysUnmeasured) {
  const test::RoomCapture room;
  Capture capture = room.open();
  capture.scans.clear();
  RegistrationOptions options;
  options.method = SessionRegistrationMethod::kPrefusion;
  const std::vector<SessionState> sessions = displaced();
  const RegistrationOut out = run_registration({capture, sessions}, {}, options);
  for (std::size_t k = 0; k < sessions.size(); ++k) {
    EXPECT_TRUE(std::isnan(out.sessions[k].outcome.overlap));
    EXPECT_EQ(out.sessions[k].T_world_session.translation, sessions[k].T_world_session.translation);
  }
  EXPECT_EQ(out.links.size(), 2U);
}

}  // namespace registration_stage_test
}  // namespace cmap
