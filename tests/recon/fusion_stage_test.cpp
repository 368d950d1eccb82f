#include <map>

#include "cmap/core/error.hpp"
#include "fusion/stage.hpp"
#include "recon/room_capture.hpp"

namespace cmap {
namespace fusion_stage_test {

using ::testing::ElementsAre;

/// Sessions and cameras where they are.
struct Placed {
  std::vector<SessionState> sessions;
  std::vector<PlacedSession> poses;

  Placed() {
    for (std::size_t k = 0; k < test::kUnits_m.size(); ++k) {
      SessionState& state = sessions.emplace_back();
      state.outcome.index = k;
      state.outcome.name = fmt::format("session_{:04}", k);
      const Eigen::Isometry3d start = test::room_camera_at(test::frame_time_s(k, 0));
      poses.push_back(placed_session(k, frames_of(test::room_session(k)),
                                     {test::kUnits_m[k], start.linear(), start.translation()}, 0.0));
    }
  }
};

TEST(FusionStage, TheMapLiesOnWhatIsThereInItsColors) {
  const test::RoomCapture room;
  const Placed placed;
  const FusionOut out = run_fusion({room.open(), placed.sessions, placed.poses, {}}, {}, {});
  ASSERT_GT(out.map.size(), 10'000U);
  EXPECT_EQ(out.points_fused, 3U * test::kFramesEach * 48 * 36) << "every pixel";
  const auto& colors = std::get<Array<RgbF>>(out.map.colors);
  std::size_t n_pure = 0;
  for (std::size_t i = 0; i < out.map.size(); ++i) {
    // Means of points of two surfaces, or of one that bends, in a voxel of 5 cm.
    EXPECT_LT(test::Room::off_m(out.map.world(i)), 0.03);
    for (std::size_t what = 0; what < 4; ++what) {
      const Rgb8 wall = test::Room::color(what);
      const double off = std::abs(colors[i][0] - wall[0] / 255.0) + std::abs(colors[i][1] - wall[1] / 255.0);
      if (off < 1e-3) ++n_pure;
    }
  }
  EXPECT_GT(n_pure, out.map.size() * 99 / 100) << "but for the edges";
}

TEST(FusionStage, EachSessionHasASketchAndAMapOfItsOwn) {
  const test::RoomCapture room;
  const Placed placed;
  std::map<std::string, std::size_t> sizes;
  const auto keep = [&](const std::string& name, const PointCloud& map) { sizes[name] = map.size(); };
  const FusionOut out = run_fusion({room.open(), placed.sessions, placed.poses, keep}, {}, {});
  EXPECT_EQ(sizes.size(), 3U);
  for (const auto& [name, size] : sizes) EXPECT_LT(size, out.map.size()) << name;
  ASSERT_EQ(out.sketches.size(), 3U);
  EXPECT_EQ(out.sketches[0].positions.size(), test::kFramesEach * 48 * 36) << "so few are all drawn";
}

TEST(FusionStage, DroppedSessionsAreNotInTheMap) {
  const test::RoomCapture room;
  Placed placed;
  placed.sessions[1].outcome.dropped = "of no use";
  placed.poses.erase(placed.poses.begin() + 1);
  std::vector<std::string> names;
  const auto keep = [&](const std::string& name, const PointCloud&) { names.push_back(name); };
  const FusionOut out = run_fusion({room.open(), placed.sessions, placed.poses, keep}, {}, {});
  EXPECT_THAT(names, ElementsAre("session_0000", "session_0002"));
  for (std::size_t i = 0; i < out.map.size(); ++i) EXPECT_LT(test::Room::off_m(out.map.world(i)), 0.03);
}

TEST(FusionStage, TheRangeIsInMetersWhateverTheUnit) {
  const test::RoomCapture room;
  const Placed placed;
  FusionOptions options;
  options.max_range_m = 3.0;
  const FusionOut out = run_fusion({room.open(), placed.sessions, placed.poses, {}}, {}, options);
  ASSERT_GT(out.map.size(), 100U);
  for (std::size_t i = 0; i < out.map.size(); ++i) {
    double nearest_m = INFINITY;
    for (const PlacedSession& session : placed.poses) {
      for (const auto& camera : session.T_world_camera) {
        nearest_m = std::min(nearest_m, (camera.translation() - out.map.world(i)).norm());
      }
    }
    EXPECT_LT(nearest_m, 3.05) << "a voxel's mean of points within 3 m of one";
  }
  options.max_range_m = 0.01;
  EXPECT_THROW(run_fusion({room.open(), placed.sessions, placed.poses, {}}, {}, options), UnsupportedError);
}

}  // namespace fusion_stage_test
}  // namespace cmap
