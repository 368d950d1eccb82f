#include "cmap/sim/predictions.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/sim/network_input.hpp"
#include "sim/sensor_testing.hpp"
#include "sim/sim_testing.hpp"

namespace cmap {
namespace predictions_test {

using testing::pinhole;
using testing::rms;

TEST(CutSessions, ShareTheirOverlap) {
  const auto sessions = cut_sessions(51, 17, 5);
  ASSERT_EQ(sessions.size(), 4u);
  EXPECT_EQ(sessions[1].first, 12u);
  EXPECT_EQ(sessions[3].first, 36u);
  EXPECT_EQ(sessions[3].count, 15u);
  EXPECT_EQ(cut_sessions(30, 30, 10).size(), 1u);
  EXPECT_EQ(cut_sessions(31, 30, 10)[1].count, 11u);
  EXPECT_EQ(cut_sessions(5, 30, 10)[0].count, 5u);
  EXPECT_TRUE(cut_sessions(0, 30, 10).empty());
  EXPECT_EQ(cut_sessions(6, 2, 0).size(), 3u);
  EXPECT_THROW(cut_sessions(50, 10, 10), UsageError);
  EXPECT_THROW(cut_sessions(50, 10, -1), UsageError);
}

/// The room with two boxes in it: depth edges.
Scene furnished_room() {
  SceneBuilder builder;
  Surface wall;
  wall.base = {0.7F, 0.6F, 0.5F};
  builder.box(wall, testing::kRoomMin, testing::kRoomMax);
  builder.box(wall, {6.0F, -3.0F, -1.0F}, {8.0F, 0.0F, 2.0F});
  builder.box(wall, {9.0F, 2.0F, -1.0F}, {11.0F, 5.0F, 3.0F});
  return builder.finish();
}

/// A camera that looks along the body's x.
Eigen::Isometry3d looking_forward(const Eigen::Isometry3d& T_world_body) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T_world_body * T;
}

struct Drive {
  CameraModel network;
  std::vector<NetworkFrame> frames;

  std::vector<const NetworkFrame*> all() const {
    std::vector<const NetworkFrame*> pointers;
    for (const NetworkFrame& frame : frames) pointers.push_back(&frame);
    return pointers;
  }
};

Drive drive(const Scene& scene, std::size_t n) {
  Drive d;
  d.network = network_camera(pinhole(640, 470, 400.0), 126);
  PathOptions options;
  options.rest_s = 0.5;
  options.sway_position_m = 0.1;
  options.sway_yaw_deg = 5.0;
  const PoseSpline path = make_path(straight_route({-15, -1, 0.5}, 0.0, 12.0), options, 1);
  for (std::size_t i = 0; i < n; ++i) {
    NetworkFrame frame;
    frame.frame = {i, 1.0 + 0.2 * static_cast<double>(i), std::to_string(i) + ".jpg", 640, 470};
    frame.T_world_camera = looking_forward(path.pose(frame.frame.time_s));
    frame.view = render_view(scene, d.network, frame.T_world_camera, {.supersampling = 1});
    d.frames.push_back(std::move(frame));
  }
  return d;
}

PredictionOptions exact() {
  PredictionOptions o;
  o.depth_noise_fraction = o.depth_bias_fraction = o.floater_fraction = 0.0;
  o.pose_noise_m = o.pose_noise_deg = o.pose_scale_fraction = o.pose_drift_fraction = o.pose_drift_deg_per_frame = 0.0;
  o.focal_noise_fraction = 0.0;
  return o;
}

/// Pixel i of frame f in the session's frame and unit, as a reader of the predictions computes it.
Eigen::Vector3d point_in_session(const SessionPredictions& p, std::size_t f, std::size_t i) {
  const auto width = static_cast<std::size_t>(p.width);
  const Eigen::Vector3d pixel(static_cast<double>(i % width), static_cast<double>(i / width), 1.0);
  const double depth = p.depth[f * p.pixels_per_frame() + i];
  return p.T_camera_session[f].inverse() * Eigen::Vector3d(depth * (p.intrinsics[f].inverse() * pixel));
}

TEST(SimulateSession, WithoutErrorsEveryPixelLiesOnTheScene) {
  const Drive d = drive(testing::room(), 6);
  PredictionOptions options = exact();
  options.world_points = true;
  const SimulatedSession s = simulate_session(d.all(), d.network, 3, options, 7);
  const SessionPredictions& p = s.predictions;
  ASSERT_EQ(p.frame_count(), 6u);
  ASSERT_EQ(p.depth.size(), 6 * p.pixels_per_frame());
  EXPECT_TRUE(p.T_camera_session[0].isApprox(Eigen::Isometry3d::Identity(), 1e-15));
  double furthest = 0.0, furthest_of_points = 0.0;
  for (std::size_t f = 0; f < p.frame_count(); ++f) {
    EXPECT_EQ(p.frames[f].index, f);
    for (std::size_t i = 0; i < p.pixels_per_frame(); ++i) {
      const Eigen::Vector3d point = point_in_session(p, f, i);
      const std::size_t k = f * p.pixels_per_frame() + i;
      furthest_of_points = std::max(furthest_of_points, (p.world_points[k].cast<double>() - point).norm());
      furthest = std::max(
          furthest, testing::distance_to_room(d.frames.front().T_world_camera * Eigen::Vector3d(s.unit_m * point)));
      EXPECT_FLOAT_EQ(p.depth_confidence[k], static_cast<float>(options.confidence_peak)) << "nothing to doubt";
    }
  }
  // Depth of the view is exact to 1e-4 m along the axis, 1.3 times that along the outermost rays.
  EXPECT_LT(furthest, 1.5e-4);
  EXPECT_LT(furthest_of_points, 1e-5);
  const Eigen::Isometry3d T_0_5 = d.frames[0].T_world_camera.inverse() * d.frames[5].T_world_camera;
  const Eigen::Isometry3d found = p.T_camera_session[5].inverse();
  EXPECT_TRUE(found.linear().isApprox(T_0_5.linear(), 1e-12));
  EXPECT_TRUE((s.unit_m * found.translation()).isApprox(T_0_5.translation(), 1e-12));
  EXPECT_EQ(p.images[p.pixels_per_frame()], d.frames[1].view.image.pixels[0]);
}

std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<double>(i);
  return rank;
}

/// Of values without ties.
double spearman(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> x = ranks(a), y = ranks(b);
  const double n = static_cast<double>(a.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
  return 1.0 - 6.0 * sum / (n * (n * n - 1.0));
}

struct DepthErrors {
  std::vector<double> error_m, relative, confidence, depth_m;
};

DepthErrors depth_errors(const SimulatedSession& s, const Drive& d) {
  DepthErrors e;
  const SessionPredictions& p = s.predictions;
  for (std::size_t k = 0; k < p.depth.size(); ++k) {
    const double truth = d.frames[k / p.pixels_per_frame()].view.depth_m[k % p.pixels_per_frame()];
    const double error = static_cast<double>(p.depth[k]) * s.unit_m - truth;
    e.error_m.push_back(std::abs(error));
    e.relative.push_back(error / truth);
    e.confidence.push_back(p.depth_confidence[k]);
    e.depth_m.push_back(truth);
  }
  return e;
}

TEST(SimulateSession, ConfidenceFallsWithTheError) {
  const Drive d = drive(furnished_room(), 8);
  const DepthErrors e = depth_errors(simulate_session(d.all(), d.network, 0, {}, 1), d);
  EXPECT_LT(spearman(e.confidence, e.error_m), -0.5);
  std::vector<double> relative;
  for (const double r : e.relative) relative.push_back(std::abs(r));
  EXPECT_LT(spearman(e.confidence, relative), -0.5);
  EXPECT_GE(std::ranges::min(e.confidence), 1.0);
  EXPECT_LE(std::ranges::max(e.confidence), 20.0);
  std::ranges::sort(relative);
  EXPECT_GT(relative[relative.size() / 2], 0.004) << "1 to 3 % is what is measured on real predictions";
  EXPECT_LT(relative[relative.size() / 2], 0.03);
}

TEST(SimulateSession, PixelNoiseHasItsStandardDeviation) {
  const Drive d = drive(testing::room(), 4);
  PredictionOptions o = exact();
  o.depth_noise_fraction = 0.02;
  const DepthErrors e = depth_errors(simulate_session(d.all(), d.network, 0, o, 1), d);
  // 49,000 pixels: 0.3 % standard error; log-normal: 0.02 instead of 0.020004.
  EXPECT_NEAR(rms(e.relative), 0.02, 0.001);
}

TEST(SimulateSession, BiasIsSmoothAndGrowsWithRange) {
  const Drive d = drive(testing::room(), 4);
  PredictionOptions o = exact();
  o.depth_bias_fraction = 0.03;
  o.depth_bias_range_m = 1000.0;
  const DepthErrors near_only = depth_errors(simulate_session(d.all(), d.network, 0, o, 1), d);
  o.depth_bias_range_m = 0.1;
  std::vector<double> far_rms;
  for (std::size_t session = 0; session < 40; ++session) {
    const DepthErrors e = depth_errors(simulate_session(d.all(), d.network, session, o, 1), d);
    far_rms.push_back(rms(e.relative));
    double step = 0.0;
    for (std::size_t i = 1; i < 126; ++i) step = std::max(step, std::abs(e.relative[i] - e.relative[i - 1]));
    // Six waves of amplitude sqrt(2/6) and at least 150 px: 6 * 0.58 * 2 pi / 150 = 0.145 of 0.03 per pixel.
    EXPECT_LT(step, 0.145 * 0.03 * 1.1);
  }
  // Over waves longer than the image it takes many sessions to see the standard deviation.
  EXPECT_NEAR(rms(far_rms), 0.03, 0.005);
  for (std::size_t i = 0; i < near_only.relative.size(); ++i) {
    ASSERT_LT(std::abs(near_only.relative[i]), 3.5 * 0.03 * near_only.depth_m[i] / 1000.0 * 1.01 + 1e-6);
  }
}

TEST(SimulateSession, FloatersStandOnlyAtDepthEdges) {
  const Drive d = drive(furnished_room(), 3);
  PredictionOptions o = exact();
  o.floater_fraction = 0.6;
  const SimulatedSession s = simulate_session(d.all(), d.network, 0, o, 1);
  const DepthErrors e = depth_errors(s, d);
  const auto width = static_cast<std::size_t>(d.network.width), height = static_cast<std::size_t>(d.network.height);
  std::size_t at_edges = 0, floating = 0;
  for (std::size_t v = 1; v + 1 < height; ++v) {
    for (std::size_t u = 1; u + 1 < width; ++u) {
      const std::size_t i = v * width + u;
      double low = e.depth_m[i], high = low;
      for (const std::size_t k : {i - 1, i + 1, i - width, i + width}) {
        low = std::min(low, e.depth_m[k]);
        high = std::max(high, e.depth_m[k]);
      }
      const double depth = e.depth_m[i] * (1.0 + e.relative[i]);
      if (high > 1.1 * low) {
        ++at_edges;
        floating += e.error_m[i] > 1e-4 ? 1 : 0;
        EXPECT_GT(depth, low * 0.9999);
        EXPECT_LT(depth, high * 1.0001);
      } else {
        EXPECT_LT(e.error_m[i], 1e-4);
      }
    }
  }
  ASSERT_GT(at_edges, 150u);
  EXPECT_NEAR(static_cast<double>(floating) / static_cast<double>(at_edges), 0.6, 0.15);
}

TEST(SimulateSession, SkyAndWhatIsBeyondTheCameraAreFarAndWithoutConfidence) {
  SceneBuilder builder;
  Surface ground;
  ground.base = {0.4F, 0.5F, 0.3F};
  builder.box(ground, {-50.0F, -50.0F, -3.0F}, {50.0F, 50.0F, -1.0F});
  const Drive d = drive(builder.finish(), 2);
  PredictionOptions o;
  o.max_depth_m = 20.0;
  o.sky_depth_m = 80.0;
  const SimulatedSession s = simulate_session(d.all(), d.network, 0, o, 1);
  std::size_t sky = 0, near = 0;
  for (std::size_t i = 0; i < s.predictions.pixels_per_frame(); ++i) {
    const float truth = d.frames[0].view.depth_m[i];
    if (truth > 20.0F) {
      ++sky;
      EXPECT_EQ(s.predictions.depth_confidence[i], 1.0F);
      EXPECT_FLOAT_EQ(s.predictions.depth[i], static_cast<float>(80.0 / s.unit_m));
    } else {
      ++near;
      EXPECT_GT(s.predictions.depth_confidence[i], 1.0F);
    }
  }
  EXPECT_GT(sky, 5000u);
  EXPECT_GT(near, 1000u);
  o.sky_depth_m = 10.0;
  EXPECT_THROW(simulate_session(d.all(), d.network, 0, o, 1), UsageError);
}

TEST(SimulateSession, UnitsAreDrawnPerSession) {
  const Drive d = drive(testing::room(), 1);
  PredictionOptions o;
  o.unit_m = 8.0;
  o.unit_factor = 4.0;
  std::vector<double> logs;
  for (std::size_t session = 0; session < 300; ++session) {
    logs.push_back(std::log(simulate_session(d.all(), d.network, session, o, 1).unit_m / 8.0) / std::log(4.0));
    EXPECT_LE(std::abs(logs.back()), 1.0);
  }
  EXPECT_NEAR(rms(logs), 1.0 / std::sqrt(3.0), 0.05) << "uniform in [-1,1]";
  o.unit_factor = 1.0;
  EXPECT_EQ(simulate_session(d.all(), d.network, 5, o, 1).unit_m, 8.0);
}

TEST(SimulateSession, OutliersStretchPosesOnly) {
  const Drive d = drive(testing::room(), 5);
  PredictionOptions o;
  const SimulatedSession plain = simulate_session(d.all(), d.network, 2, o, 1);
  o.outlier_sessions = {2};
  o.outlier_stretch = 1.5;
  const SimulatedSession outlier = simulate_session(d.all(), d.network, 2, o, 1);
  EXPECT_EQ(plain.pose_stretch, 1.0);
  EXPECT_EQ(outlier.pose_stretch, 1.5);
  EXPECT_EQ(outlier.predictions.depth, plain.predictions.depth);
  for (std::size_t i = 1; i < 5; ++i) {
    const Eigen::Isometry3d a = plain.predictions.T_camera_session[i].inverse(),
                            b = outlier.predictions.T_camera_session[i].inverse();
    EXPECT_TRUE(b.translation().isApprox(1.5 * a.translation(), 1e-12));
    EXPECT_TRUE(b.linear().isApprox(a.linear(), 1e-12));
  }
  o.outlier_sessions.clear();
  o.outlier_fraction = 0.3;
  int outliers = 0;
  for (std::size_t session = 0; session < 200; ++session) {
    outliers += simulate_session(d.all(), d.network, session, o, 1).pose_stretch != 1.0 ? 1 : 0;
  }
  EXPECT_NEAR(outliers, 60, 20) << "3 standard deviations of a binomial";
}

TEST(SimulateSession, PosesDriftAsRealOnesDo) {
  // 30 frames, 0.2 m apart: the end is off by centimeters and tenths of a degree, not by more.
  Drive d = drive(testing::room(), 30);
  std::vector<double> position, angle;
  for (std::size_t session = 0; session < 60; ++session) {
    const SimulatedSession s = simulate_session(d.all(), d.network, session, {}, 1);
    const Eigen::Isometry3d truth = d.frames[0].T_world_camera.inverse() * d.frames[29].T_world_camera;
    const Eigen::Isometry3d found = s.predictions.T_camera_session[29].inverse();
    position.push_back((s.unit_m * found.translation() - truth.translation()).norm());
    angle.push_back(Eigen::AngleAxisd(found.linear().transpose() * truth.linear()).angle() * 180 / M_PI);
  }
  EXPECT_GT(rms(position), 0.02);
  EXPECT_LT(rms(position), 0.2) << "10-20 cm are reported for real sequences";
  // 29 steps of 0.08 deg per axis, own error 0.1: sqrt(3 (29 0.08^2 + 0.1^2)) = 0.77 deg.
  EXPECT_NEAR(rms(angle), 0.77, 0.12);
}

TEST(SimulateSession, SharedFramesGetOtherErrorsAndThreadsNone) {
  const Drive d = drive(testing::room(), 3);
  const auto run = [&](int threads, std::size_t session) {
    const ExecutionScope limit({.threads = threads});
    return simulate_session(d.all(), d.network, session, {}, 1);
  };
  const SimulatedSession one = run(1, 0), four = run(4, 0), other = run(1, 1);
  EXPECT_EQ(one.predictions.depth, four.predictions.depth);
  EXPECT_EQ(one.predictions.depth_confidence, four.predictions.depth_confidence);
  EXPECT_NE(one.unit_m, other.unit_m);
  std::vector<double> differences;
  for (std::size_t i = 0; i < one.predictions.depth.size(); ++i) {
    const double a = one.unit_m * static_cast<double>(one.predictions.depth[i]);
    const double b = other.unit_m * static_cast<double>(other.predictions.depth[i]);
    differences.push_back((a - b) / a);
  }
  EXPECT_GT(rms(differences), 0.005);
}

TEST(SimulateSession, RefusesWhatCannotBe) {
  const Drive d = drive(testing::room(), 1);
  PredictionOptions o;
  o.confidence_peak = 0.5;
  EXPECT_THROW(simulate_session(d.all(), d.network, 0, o, 1), UsageError);
  EXPECT_THROW(simulate_session({}, d.network, 0, {}, 1), std::invalid_argument);
  CameraModel larger = d.network;
  larger.width += 14;
  EXPECT_THROW(simulate_session(d.all(), larger, 0, {}, 1), std::invalid_argument);
}

}  // namespace predictions_test
}  // namespace cmap
