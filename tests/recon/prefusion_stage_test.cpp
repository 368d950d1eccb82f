#include "prefusion/stage.hpp"
#include "recon/room_capture.hpp"

namespace cmap {
namespace prefusion_stage_test {

using test::kUnits_m;
using ::testing::HasSubstr;

PreFusionOut pre_fused(const test::RoomCapture& room, std::optional<std::size_t> only_session = {}) {
  return run_pre_fusion({room.open(), only_session}, {}, {});
}

TEST(PreFusionStage, PlacesExactSessionsExactly) {
  const PreFusionOut out = pre_fused(test::RoomCapture());
  ASSERT_EQ(out.sessions.size(), kUnits_m.size());
  for (std::size_t k = 0; k < kUnits_m.size(); ++k) {
    const SessionState& session = out.sessions[k];
    EXPECT_TRUE(session.is_kept());
    EXPECT_EQ(session.outcome.frames, test::kFramesEach);
    // Depths are floats, and so is what they say of the ratios.
    EXPECT_NEAR(session.outcome.scale_prefusion / kUnits_m[k], 1.0, 1e-6);
    EXPECT_LT(test::camera_error_m(session.placed), 1e-5);
    EXPECT_EQ(session.placed.index, k);
    EXPECT_EQ(session.min_confidence, 3.0) << "all pixels have it";
    EXPECT_TRUE(session.outcome.flags.empty());
  }
}

TEST(PreFusionStage, ASessionThatCannotBeReadIsDroppedAndTheOthersStay) {
  const test::RoomCapture room;
  std::filesystem::remove(room.session(1) / "depth.npy");
  const PreFusionOut out = pre_fused(room);
  ASSERT_EQ(out.sessions.size(), 3U);
  ASSERT_FALSE(out.sessions[1].is_kept());
  EXPECT_THAT(*out.sessions[1].outcome.dropped, HasSubstr("depth.npy: no such file"));
  EXPECT_EQ(placed_of(out.sessions).size(), 2U);
  for (const PlacedSession& placed : placed_of(out.sessions)) EXPECT_LT(test::camera_error_m(placed), 1e-5);
}

TEST(PreFusionStage, OneSessionAlone) {
  const PreFusionOut out = pre_fused(test::RoomCapture(), 2);
  ASSERT_EQ(out.sessions.size(), 1U);
  EXPECT_EQ(out.sessions[0].outcome.index, 2U);
  EXPECT_EQ(out.sessions[0].outcome.name, "session_0002");
}

/// The path of session 1 is 40 % too long for its depths. The neighbors' scale holds for the depths, its own for the
/// path, so that the cameras are where they are.
TEST(PreFusionStage, AnOutlierKeepsItsPath) {
  const test::RoomCapture room;
  SessionPredictions session = test::room_session(1);
  for (Eigen::Isometry3d& pose : session.T_camera_session) pose.translation() *= 1.4;
  std::filesystem::remove_all(room.session(1));
  write_session_predictions(session, room.session(1));
  const SessionState state = pre_fused(room).sessions.at(1);
  EXPECT_FALSE(state.outcome.scale_inlier);
  EXPECT_NEAR(state.outcome.scale_prefusion / kUnits_m[1], 1.0, 0.01);
  EXPECT_NEAR(state.center_factor, 1.0 / 1.4, 0.01);
  EXPECT_LT(test::camera_error_m(state.placed), 0.01);
}

}  // namespace prefusion_stage_test
}  // namespace cmap
