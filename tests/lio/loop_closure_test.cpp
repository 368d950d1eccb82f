#include "cmap/lio/loop_closure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/core/random_hash.hpp"

// Input that no drive gives; loops of a drive are in loop_town_test.cpp, of a real hall in loop_balm_hall_test.cpp.

namespace cmap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A keyframe at a place on the x axis with points at random about it.
Keyframe cloud_at(double time_s, double x_m, std::uint64_t seed, std::size_t n = 400) {
  Keyframe keyframe;
  keyframe.time_s = time_s;
  keyframe.T_world_body.translation().x() = x_m;
  const auto random = [&](std::uint64_t i) { return static_cast<float>(random_below(4000, i, seed)) / 100.0F - 20.0F; };
  for (std::uint64_t i = 0; i < n; ++i) {
    keyframe.points_body.push_back({random(3 * i), random(3 * i + 1), 0.2F * random(3 * i + 2)});
  }
  return keyframe;
}

/// Out to 60 m and back, everywhere other points: it looks like nothing it has seen.
std::vector<Keyframe> out_and_back() {
  std::vector<Keyframe> keyframes;
  for (int k = 0; k <= 60; ++k) {
    keyframes.push_back(cloud_at(k, k <= 30 ? 2.0 * k : 120.0 - 2.0 * k, static_cast<std::uint64_t>(k)));
  }
  return keyframes;
}

void expect_unchanged(const LoopClosure& closure, const std::vector<Keyframe>& keyframes) {
  ASSERT_EQ(closure.poses.size(), keyframes.size());
  EXPECT_EQ(closure.n_loops, 0U);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    EXPECT_TRUE(closure.poses[k].matrix() == keyframes[k].T_world_body.matrix());
  }
}

TEST(LoopClosure, NoKeyframesNoLoops) { expect_unchanged(close_loops({}, LoopOptions{}), {}); }

TEST(LoopClosure, OneKeyframeNoLoops) {
  const std::vector<Keyframe> one{cloud_at(0.0, 5.0, 1)};
  expect_unchanged(close_loops(one, LoopOptions{}), one);
}

TEST(LoopClosure, KeyframesWithoutPointsNoLoops) {
  std::vector<Keyframe> keyframes = out_and_back();
  for (Keyframe& keyframe : keyframes) keyframe.points_body.clear();
  const LoopClosure closure = close_loops(keyframes, LoopOptions{});
  EXPECT_EQ(closure.n_submaps, 0U);
  expect_unchanged(closure, keyframes);
}

TEST(LoopClosure, SomeWithoutPointsAreNoFault) {
  std::vector<Keyframe> keyframes = out_and_back();
  for (std::size_t k = 0; k < keyframes.size(); k += 3) keyframes[k].points_body.clear();
  expect_unchanged(close_loops(keyframes, LoopOptions{}), keyframes);
}

TEST(LoopClosure, WhatHasNothingInCommonIsNamedAndRejected) {
  const std::vector<Keyframe> keyframes = out_and_back();
  const LoopClosure closure = close_loops(keyframes, LoopOptions{});
  EXPECT_FALSE(closure.candidates.empty());
  for (const LoopCandidate& c : closure.candidates) {
    EXPECT_FALSE(c.accepted);
    EXPECT_FALSE(c.reason.empty());
    EXPECT_LT(c.from, c.to);
  }
  expect_unchanged(closure, keyframes);
}

TEST(LoopClosure, OnlyGroundTellsNoLoop) {
  std::vector<Keyframe> keyframes = out_and_back();
  for (Keyframe& keyframe : keyframes) {
    for (Eigen::Vector3f& p : keyframe.points_body) p.z() = -1.5F;
  }
  const LoopClosure closure = close_loops(keyframes, LoopOptions{});
  ASSERT_FALSE(closure.candidates.empty());
  for (const LoopCandidate& c : closure.candidates) EXPECT_EQ(c.verdict.verdict, Verdict::kUnsupported);
  expect_unchanged(closure, keyframes);
}

TEST(LoopClosure, RefusesWhatIsNotFinite) {
  const std::vector<Keyframe> good = out_and_back();
  const auto with = [&](auto&& spoil) {
    std::vector<Keyframe> keyframes = good;
    spoil(keyframes[7]);
    return keyframes;
  };
  const auto refuses = [](const std::vector<Keyframe>& keyframes) {
    EXPECT_THROW(close_loops(keyframes, LoopOptions{}), std::invalid_argument);
  };
  refuses(with([](Keyframe& k) { k.T_world_body.translation().y() = kNaN; }));
  refuses(with([](Keyframe& k) { k.T_world_body.linear()(1, 1) = kNaN; }));
  refuses(with([](Keyframe& k) { k.T_world_body.linear() *= 1.1; }));
  refuses(with([](Keyframe& k) { k.T_world_body.linear().col(0) *= -1.0; }));
  refuses(with([](Keyframe& k) { k.time_s = kNaN; }));
  refuses(with([](Keyframe& k) { k.time_s = 6.0; }));
  refuses(with([](Keyframe& k) { k.points_body[3].z() = std::numeric_limits<float>::infinity(); }));
  try {
    close_loops(with([](Keyframe& k) { k.time_s = kNaN; }), LoopOptions{});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "keyframe 7: its time is not finite");
  }
}

TEST(LoopOptions, NameTheFieldThatIsWrong) {
  LoopOptions options;
  options.submap_spacing_m = 0.0;
  try {
    close_loops({}, options);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("submap_spacing_m"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(check_options(LoopOptions{}));
  EXPECT_NO_THROW(check_options(indoor_loop_options()));
}

TEST(LoopOptions, FollowTheGroundThatThePathCovers) {
  std::vector<Keyframe> keyframes = out_and_back();
  EXPECT_EQ(loop_options_for(keyframes).submap_m, LoopOptions{}.submap_m);
  keyframes.resize(10);
  EXPECT_EQ(loop_options_for(keyframes).submap_m, indoor_loop_options().submap_m);
  EXPECT_EQ(loop_options_for({}).submap_m, LoopOptions{}.submap_m);
}

TEST(LoopsJson, HasEveryCandidateAndNullForWhatIsNot) {
  const std::vector<Keyframe> keyframes = out_and_back();
  LoopClosure closure = close_loops(keyframes, LoopOptions{});
  LoopCandidate candidate;
  candidate.from = 1;
  candidate.to = 40;
  closure.candidates.push_back(candidate);
  candidate.to = 39;
  candidate.rmse_m = 0.1;
  candidate.error_m = 0.02;
  closure.candidates.push_back(candidate);
  const nlohmann::ordered_json json = loops_json(closure, keyframes, LoopOptions{});
  ASSERT_EQ(json["candidates"].size(), closure.candidates.size());
  const auto& not_aligned = json["candidates"][closure.candidates.size() - 2];
  EXPECT_TRUE(not_aligned["rmse_m"].is_null());
  EXPECT_TRUE(not_aligned["T_from_to"].is_null());
  EXPECT_EQ(not_aligned["alignment"]["verdict"], "not judged");
  const auto& aligned = json["candidates"].back();
  EXPECT_EQ(aligned["rmse_m"], 0.1);
  EXPECT_EQ(aligned["T_from_to"].size(), 4U);
  EXPECT_TRUE(aligned["graph_residual"].is_null());
  EXPECT_EQ(aligned["source"], "pose");
  EXPECT_EQ(aligned["to_time_s"], 39.0);
  EXPECT_EQ(json["options"]["submap_m"], 30.0);
  EXPECT_EQ(json["keyframes"], keyframes.size());
}

}  // namespace
}  // namespace cmap
