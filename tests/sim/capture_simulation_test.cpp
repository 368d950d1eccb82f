#include "cmap/sim/capture_simulation.hpp"

#include <map>
#include <nlohmann/json.hpp>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/io/capture.hpp"
#include "cmap/io/image_file.hpp"
#include "cmap/io/lidar_scan_file.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/session_file.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "io/io_testing.hpp"
#include "sim/sensor_testing.hpp"

namespace cmap {
namespace capture_simulation_test {

namespace fs = std::filesystem;
using testing::TempFolder;

/// A few seconds of a street with all errors of sensors off.
CaptureOptions tiny(bool with_errors) {
  CaptureOptions o;
  apply_capture_preset(o, "small_town");
  o.scene.town.block_x_m = o.scene.town.block_y_m = 32.0;
  o.scene.town.trees_per_100m = o.scene.town.cars_per_100m = 2.0;
  o.route.length_m = 8.0;
  o.camera.width_px = 160;
  o.camera.height_px = 120;
  o.camera.focal_px = 110.0;
  o.camera.format = PictureFormat::kPng;
  o.predictions.width_px = 70;
  o.predictions.session_length = 4;
  o.truth.map_points_per_m2 = 10.0;
  if (with_errors) return o;
  o.lidar.range_noise_m = o.lidar.angular_noise_deg = 0.0;
  o.stated.lio_drift_m_per_sqrt_m = o.stated.lio_drift_deg_per_sqrt_m = 0.0;
  PredictionOptions& p = o.predictions;
  p.depth_noise_fraction = p.depth_bias_fraction = p.floater_fraction = p.focal_noise_fraction = 0.0;
  p.pose_noise_m = p.pose_noise_deg = p.pose_scale_fraction = p.pose_drift_fraction = p.pose_drift_deg_per_frame = 0.0;
  return o;
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = testing::read_bytes(entry.path());
    }
  }
  return files;
}

StampedPose pose_near(const Trajectory& trajectory, double time_s) {
  return *std::ranges::min_element(trajectory, {}, [&](const StampedPose& p) { return std::abs(p.time_s - time_s); });
}

Eigen::Isometry3d isometry(const StampedPose& pose) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = pose.rotation.toRotationMatrix();
  T.translation() = pose.position;
  return T;
}

/// Distance from p to the scene's surface, looked for along six directions from a little off.
double distance_to_scene(const Scene& scene, const Eigen::Vector3d& p) {
  double nearest = 1.0;
  constexpr double kOff = 0.05;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d direction = sign * Eigen::Vector3d::Unit(axis);
      if (const auto hit = scene.cast(p - kOff * direction, direction, 1.0)) {
        // To the plane that was hit, not along the axis.
        nearest =
            std::min(nearest, std::abs(hit->distance_m - kOff) * std::abs(hit->normal.cast<double>().dot(direction)));
      }
    }
  }
  return nearest;
}

TEST(SimulateCapture, IsReadBackAndAgreesWithItsTruth) {
  const TempFolder folder;
  const CaptureOptions options = tiny(false);
  simulate_capture(options, folder / "capture");
  const Capture capture = open_capture(folder / "capture");
  EXPECT_TRUE(capture.warnings.empty());
  const Scene scene = make_scene(options.scene);
  const Trajectory truth = read_trajectory(folder / "capture/truth/trajectory.tum").poses;
  ASSERT_GT(capture.scans.size(), 30u);
  ASSERT_GT(capture.images.size(), 6u);
  EXPECT_GT(capture.imu.size(), 600u);
  ASSERT_EQ(capture.lio.size(), capture.scans.size() + 1);
  EXPECT_TRUE(isometry(capture.lio[20]).isApprox(isometry(pose_near(truth, capture.lio[20].time_s)), 1e-9));
  EXPECT_EQ(read_image(capture.images[0].path, capture.calibration.camera).width, 160);

  // A scan at rest needs no deskewing: its points lie on the scene.
  const LidarScan scan = read_lidar_scan(capture.scans[2].path, capture.scans[2].time_s);
  const Eigen::Isometry3d T_world_lidar = isometry(truth[20]) * capture.calibration.T_imu_lidar;
  std::vector<double> distances;
  for (std::size_t i = 0; i < scan.positions.size(); i += 7) {
    distances.push_back(distance_to_scene(scene, T_world_lidar * scan.positions[i].cast<double>()));
  }
  std::ranges::sort(distances);
  // Leaves and thin things may be missed by the six rays; the rest is exact to rounding.
  EXPECT_LT(distances[distances.size() * 9 / 10], 1e-4);
}

TEST(SimulateCapture, PredictionsLieOnTheSceneByTrueScaleAndPose) {
  const TempFolder folder;
  const CaptureOptions options = tiny(false);
  simulate_capture(options, folder / "capture");
  const Capture capture = open_capture(folder / "capture");
  const Scene scene = make_scene(options.scene);
  const PoseSpline path = make_path(make_route(scene, options.route), options.path, 1);
  const auto scales = nlohmann::json::parse(testing::read_bytes(folder / "capture/truth/scales.json"));
  ASSERT_GE(capture.sessions.size(), 2u);
  for (const fs::path& session : capture.sessions) {
    const SessionPredictions p = read_session_predictions(session);
    EXPECT_TRUE(p.warnings.empty());
    const double unit_m = scales["scales"][session.stem().string()];
    const std::size_t last = p.frame_count() - 1;
    const Eigen::Isometry3d T_world_first =
        path.pose(p.frames[0].time_s) * capture.calibration.T_imu_lidar * capture.calibration.T_lidar_camera;
    std::vector<double> distances;
    for (std::size_t i = 0; i < p.pixels_per_frame(); i += 11) {
      const std::size_t k = last * p.pixels_per_frame() + i;
      if (p.depth_confidence[k] <= 1.0F) continue;  // sky
      const auto width = static_cast<std::size_t>(p.width);
      const Eigen::Vector3d pixel(static_cast<double>(i % width), static_cast<double>(i / width), 1.0);
      Eigen::Vector3d point = p.T_camera_session[last].inverse() *
                              Eigen::Vector3d(static_cast<double>(p.depth[k]) * (p.intrinsics[last].inverse() * pixel));
      distances.push_back(distance_to_scene(scene, T_world_first * Eigen::Vector3d(unit_m * point)));
    }
    std::ranges::sort(distances);
    ASSERT_GT(distances.size(), 100u);
    EXPECT_LT(distances[distances.size() * 9 / 10], 3e-4) << "depth to 1e-4 m, float, along inclined rays";
  }
}

TEST(SimulateCapture, TheTrueMapIsWhatPicturesSaw) {
  const TempFolder folder;
  CaptureOptions options = tiny(false);
  options.truth.map_max_distance_m = 25.0;
  simulate_capture(options, folder / "capture");
  const PointCloud map = read_point_cloud(folder / "capture/truth/map.ply").cloud;
  const Trajectory truth = read_trajectory(folder / "capture/truth/trajectory.tum").poses;
  ASSERT_GT(map.size(), 1000u);
  EXPECT_TRUE(map.has_color());
  const Scene scene = make_scene(options.scene);
  const Capture capture = open_capture(folder / "capture");
  const Eigen::Isometry3d T_imu_camera = capture.calibration.T_imu_lidar * capture.calibration.T_lidar_camera;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < map.size(); i += 50) {
    bool visible = false;
    for (const StampedFile& image : capture.images) {
      const Eigen::Vector3d camera = isometry(pose_near(truth, image.time_s)) * T_imu_camera.translation();
      const Eigen::Vector3d way = map.world(i) - camera;
      EXPECT_LT(distance_to_scene(scene, map.world(i)), 0.06);
      const auto hit = scene.probe(camera, way.normalized(), 1e3);
      visible = visible || (hit && hit->distance_m > way.norm() - 0.02);
    }
    seen += visible ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(seen), 0.99 * static_cast<double>((map.size() + 49) / 50))
      << "but for rays that graze an edge";
}

/// Sessions are of every second picture; the last one ends where the pictures do.
TEST(SimulateCapture, CutsSessionsOfEveryNthPicture) {
  const TempFolder folder;
  CaptureOptions o = tiny(false);
  o.camera.rate_hz = 4.0;
  o.predictions.image_stride = 2;
  o.predictions.session_length = 5;
  o.predictions.session_overlap = 2;
  simulate_capture(o, folder.path() / "capture");
  const Capture capture = open_capture(folder.path() / "capture");
  const auto ranges = cut_sessions((capture.images.size() + 1) / 2, 5, 2);
  ASSERT_GE(ranges.size(), 2U);
  ASSERT_EQ(capture.sessions.size(), ranges.size());
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const SessionPredictions session = read_session_predictions(capture.sessions[k]);
    ASSERT_EQ(session.frame_count(), ranges[k].count);
    for (std::size_t f = 0; f < ranges[k].count; ++f) {
      EXPECT_EQ(session.frames[f].time_s, capture.images[2 * (ranges[k].first + f)].time_s);
    }
  }
  o.predictions.session_length = 1000;
  simulate_capture(o, folder.path() / "one");
  EXPECT_EQ(open_capture(folder.path() / "one").sessions.size(), 1U);
}

TEST(SimulateCapture, SameBytesForAnyNumberOfThreads) {
  const TempFolder folder;
  CaptureOptions options = tiny(true);
  options.camera.pixel_noise_u8 = 3.0;
  options.camera.exposure_noise = 0.1;
  options.predictions.world_points = true;
  const auto run = [&](const char* name, int threads, int seed) {
    const ExecutionScope limit({.threads = threads});
    options.seed = seed;
    simulate_capture(options, folder / name);
    return files_of(folder / name);
  };
  const auto one = run("one", 1, 1), three = run("three", 3, 1), other = run("other", 3, 2);
  ASSERT_EQ(one.size(), three.size());
  for (const auto& [name, bytes] : one) EXPECT_TRUE(three.at(name) == bytes) << name;
  EXPECT_FALSE(one.at("imu.csv") == other.at("imu.csv"));
  EXPECT_FALSE(one.at("lidar/000010.pcd") == other.at("lidar/000010.pcd"));
}

TEST(SimulateCapture, StatedErrorsAreInTheCalibrationAndTheStampsOnly) {
  const TempFolder folder;
  CaptureOptions options = tiny(false);
  simulate_capture(options, folder / "right");
  options.stated.camera_rotation_error_deg = {0, 2, 0};
  options.stated.image_time_error_s = 0.1;
  simulate_capture(options, folder / "wrong");
  const Capture right = open_capture(folder / "right"), wrong = open_capture(folder / "wrong");
  const Eigen::Matrix3d turn =
      right.calibration.T_lidar_camera.linear().transpose() * wrong.calibration.T_lidar_camera.linear();
  EXPECT_NEAR(Eigen::AngleAxisd(turn).angle() * 180 / M_PI, 2.0, 1e-9);
  EXPECT_NEAR(wrong.images[3].time_s - right.images[3].time_s, 0.1, 1e-9);
  EXPECT_EQ(testing::read_bytes(right.images[3].path), testing::read_bytes(wrong.images[3].path));
  EXPECT_EQ(testing::read_bytes(right.scans[3].path), testing::read_bytes(wrong.scans[3].path));
}

TEST(SimulateCapture, ChainsErrorsOfOutlierSessions) {
  const TempFolder folder;
  CaptureOptions options = tiny(false);
  options.predictions.outlier_sessions = {1};
  simulate_capture(options, folder / "capture");
  const auto scales = nlohmann::json::parse(testing::read_bytes(folder / "capture/truth/scales.json"));
  EXPECT_EQ(scales["pose_stretch"].size(), 1u);
  EXPECT_EQ(scales["pose_stretch"]["session_0001"], 1.6);
}

TEST(SimulateCapture, LeavesNothingBehindWhereItCannotBe) {
  const TempFolder folder;
  const auto refused = [&](auto&& change) {
    CaptureOptions options = tiny(false);
    change(options);
    EXPECT_THROW(simulate_capture(options, folder / "capture"), UsageError);
    EXPECT_TRUE(fs::is_empty(folder.path()));
  };
  refused([](CaptureOptions& o) { o.imu.rate_hz = -1; });
  refused([](CaptureOptions& o) { o.camera.begin_s = 1000; });
  refused([](CaptureOptions& o) { o.predictions.width_px = 100; });
  refused([](CaptureOptions& o) { o.predictions.session_overlap = o.predictions.session_length; });
  refused([](CaptureOptions& o) { o.route.name = "survey"; });
  refused([](CaptureOptions& o) { o.route.begin_m = 1e6; });
  refused([](CaptureOptions& o) { o.scene.town.blocks_x = 0; });
  fs::create_directory(folder / "capture");
  EXPECT_THROW(simulate_capture(tiny(false), folder / "capture"), OutputError) << "the folder exists";
}

TEST(MakeRoute, CutsWaysOfTheScene) {
  const Scene scene = make_town({});
  RouteChoice choice;
  choice.name = "block_loop";
  choice.overlap_m = 20.0;
  const auto length = [](const Route& route) {
    double sum = 0.0;
    for (std::size_t i = 1; i < route.size(); ++i) sum += (route[i] - route[i - 1]).norm();
    return sum;
  };
  const double whole = length(make_route(scene, choice));
  choice.overlap_m = 0.0;
  const double once = length(make_route(scene, choice));
  EXPECT_NEAR(whole - once, 20.0, 1.5) << "points of the way are up to 1 m apart";
  choice.begin_m = 10.0;
  EXPECT_NEAR(length(make_route(scene, choice)), once - 10.0, 1e-6);
  choice.length_m = 33.0;
  EXPECT_NEAR(length(make_route(scene, choice)), 33.0, 1e-6);
  choice.kind = RouteKind::kStraight;
  const Route straight = make_route(scene, choice);
  EXPECT_NEAR(straight.front().z(), scene.ground_height_m(straight.front().x(), straight.front().y()) + 1.6, 0.2);
  choice.kind = RouteKind::kHover;
  EXPECT_EQ(make_route(scene, choice).size(), 1u);
  choice.kind = RouteKind::kBlock;
  EXPECT_THROW(make_route(scene, choice), UsageError) << "without a box";
  choice.max_m = {30, 20};
  EXPECT_NEAR(length(make_route(scene, choice)), 33.0, 1e-6);
}

}  // namespace capture_simulation_test
}  // namespace cmap
