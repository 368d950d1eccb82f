#include "described_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "registration/stage.hpp"

namespace cmap {
namespace described_state_test {

using Json = nlohmann::ordered_json;

/// Numbers that a decimal text easily spoils, a session of each kind.
RegistrationOut odd() {
  SessionState kept;
  kept.outcome.index = 7;
  kept.outcome.name = "a \"name\"";
  kept.outcome.frames = 2;
  kept.outcome.scale_prefusion = 1.0 / 3.0;
  kept.outcome.scale_registration = 0.1;
  kept.outcome.rotation_corrected = true;
  kept.outcome.overlap = kept.outcome.rmse_m = std::numeric_limits<double>::quiet_NaN();
  kept.outcome.flags = {"one", ""};
  kept.T_world_session.scale = 5e-324;
  kept.T_world_session.rotation = Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  kept.T_world_session.translation << 1e300, -0.0, 4e6 + 1.0 / 7.0;
  kept.center_factor = 1.4;
  kept.placed.index = 7;
  kept.placed.time_s = {1317042504.967931, 0.1};
  kept.placed.T_world_camera.resize(2, Eigen::Isometry3d::Identity());
  kept.placed.T_world_camera[1].translation() << 0.1, 0.2, 0.3;
  SessionState dropped;
  dropped.outcome.dropped = "";  // a reason, however short
  RegistrationOut out{{kept, dropped}, {SessionLink{}}};
  out.links[0].n_points = 12'345'678'901;
  out.links[0].T_from_to.translate(Eigen::Vector3d(1.0 / 3.0, 0, 0));
  return out;
}

std::optional<RegistrationOut> read(const Json& json) { return state_from<RegistrationOut>(json); }

TEST(DescribedState, ReadsBackWhatItWrote) {
  const RegistrationOut out = odd();
  const auto back = read(Json::parse(state_json(out).dump()));
  ASSERT_TRUE(back);
  const SessionState &a = out.sessions[0], &b = back->sessions.at(0);
  EXPECT_EQ(b.outcome.index, 7U);
  EXPECT_EQ(b.outcome.name, a.outcome.name);
  EXPECT_EQ(b.outcome.scale_prefusion, a.outcome.scale_prefusion);
  EXPECT_TRUE(b.outcome.rotation_corrected);
  EXPECT_TRUE(std::isnan(b.outcome.overlap));
  EXPECT_EQ(b.outcome.flags, a.outcome.flags);
  EXPECT_TRUE(b.is_kept());
  EXPECT_EQ(b.T_world_session.scale, 5e-324);
  EXPECT_EQ(b.T_world_session.rotation, a.T_world_session.rotation);
  EXPECT_EQ(b.T_world_session.translation, a.T_world_session.translation);
  EXPECT_TRUE(std::signbit(b.T_world_session.translation.y()));
  EXPECT_EQ(b.placed.time_s, a.placed.time_s);
  EXPECT_EQ(b.placed.T_world_camera[1].matrix(), a.placed.T_world_camera[1].matrix());
  EXPECT_FALSE(back->sessions.at(1).is_kept());
  EXPECT_EQ(back->links.at(0).n_points, 12'345'678'901U);
  EXPECT_EQ(back->links.at(0).T_from_to.matrix(), out.links[0].T_from_to.matrix());
  EXPECT_EQ(state_json(*back).dump(), state_json(out).dump()) << "and all the rest";
}

TEST(DescribedState, WhatFollowsIsWrittenForPeople) {
  const Json outcome = state_json(odd()).at("sessions")[0].at("outcome");
  EXPECT_EQ(outcome.at("scale"), 1.0 / 3.0 * 0.1);
  EXPECT_TRUE(outcome.at("overlap").is_null()) << "NaN";
  EXPECT_TRUE(outcome.at("dropped").is_null()) << "no reason";
}

/// Any change of the layout or of a type, anywhere.
TEST(DescribedState, ReadsNothingElse) {
  const Json whole = Json::parse(state_json(odd()).dump());
  ASSERT_TRUE(read(whole));
  const std::vector<std::pair<const char*, Json>> changes{
      {"/links", Json::object()},
      {"/links/0/from", -1},
      {"/links/0/from", 1.5},
      {"/links/0/refined", 1},
      {"/links/0/T_from_to", {1, 2, 3}},
      {"/links/0/T_from_to/3", nullptr},
      {"/links/0/rmse_m", nullptr},
      {"/links/0/rmse_m", "0.1"},
      {"/links/0/unknown", 1},
      {"/sessions/0", nullptr},
      {"/sessions/0/outcome/name", 3},
      {"/sessions/0/outcome/flags", "one"},
      {"/sessions/0/outcome/dropped", 1},
      {"/sessions/0/T_world_session/rotation", {1, 0, 0, 0, 1, 0, 0, 0}},
      {"/sessions/0/placed/time_s/0", nullptr},
  };
  for (const auto& [place, value] : changes) {
    Json changed = whole;
    changed[Json::json_pointer(place)] = value;
    EXPECT_FALSE(read(changed)) << place << " = " << value;
  }
  for (const char* place : {"/links", "/links/0/from", "/sessions/0/outcome", "/sessions/0/outcome/scale"}) {
    Json changed = whole;
    const Json::json_pointer pointer(place);
    changed[pointer.parent_pointer()].erase(pointer.back());
    EXPECT_FALSE(read(changed)) << "without " << place;
  }
  EXPECT_FALSE(read(Json()));
  EXPECT_FALSE(read(3));
}

}  // namespace described_state_test
}  // namespace cmap
