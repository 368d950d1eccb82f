#include "cmap/sim/lidar.hpp"

#include <set>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "sim/sensor_testing.hpp"

namespace cmap {
namespace lidar_test {

using testing::room;
using testing::walk;

struct Angles {
  double azimuth_deg, elevation_deg;
};
Angles angles(const Eigen::Vector3d& d) {
  return {std::atan2(d.y(), d.x()) * 180.0 / M_PI, std::asin(d.z()) * 180.0 / M_PI};
}

TEST(LidarBeam, SpinningLinesHaveTheirElevations) {
  for (const auto& [name, lines, low, high] : {std::tuple{"spinning_16", 16u, -15.0, 15.0},
                                               {"spinning_32", 32u, -30.67, 10.67},
                                               {"spinning_64", 64u, -24.33, 2.0}}) {
    const LidarOptions o = lidar_model(name);
    ASSERT_EQ(o.elevations_deg.size(), lines) << name;
    std::set<double> seen;
    float before = 0.0F;
    for (std::size_t i = 0; i < beams_per_scan(o); ++i) {
      const LidarBeam beam = lidar_beam(o, 12.3, i);
      ASSERT_NEAR(angles(beam.direction).elevation_deg, o.elevations_deg[beam.line], 1e-9);
      ASSERT_NEAR(beam.direction.norm(), 1.0, 1e-12);
      ASSERT_GE(beam.time_s, before);
      before = beam.time_s;
      seen.insert(o.elevations_deg[beam.line]);
    }
    EXPECT_EQ(seen.size(), lines);
    EXPECT_NEAR(*seen.begin(), low, 0.01);
    EXPECT_NEAR(*seen.rbegin(), high, 0.01);
    EXPECT_LT(before, 0.1F);
    EXPECT_GT(before, 0.0999F);
  }
}

TEST(LidarBeam, SpinningTurnsClockwiseFromBehind) {
  const LidarOptions o = lidar_model("spinning_16");
  const auto at_quarter = [&](std::size_t quarter) {
    return angles(lidar_beam(o, 0.0, quarter * beams_per_scan(o) / 4).direction).azimuth_deg;
  };
  EXPECT_NEAR(std::abs(at_quarter(0)), 180.0, 1e-9);
  EXPECT_NEAR(at_quarter(1), 90.0, 1e-9) << "left";
  EXPECT_NEAR(at_quarter(2), 0.0, 1e-9) << "forward in the middle of the scan";
  EXPECT_NEAR(at_quarter(3), -90.0, 1e-9);
}

/// Cells of one degree that some shot of the first `seconds` falls into.
std::size_t covered_cells(const LidarOptions& o, double seconds) {
  std::set<std::pair<int, int>> cells;
  for (double start = 0.0; start < seconds - 1e-9; start += 1.0 / o.scan_rate_hz) {
    for (std::size_t i = 0; i < beams_per_scan(o); ++i) {
      const Angles a = angles(lidar_beam(o, start, i).direction);
      cells.insert({static_cast<int>(std::floor(a.azimuth_deg)), static_cast<int>(std::floor(a.elevation_deg))});
    }
  }
  return cells.size();
}

TEST(LidarBeam, RosettesCoverMoreWithTime) {
  for (const char* name : {"avia", "mid360"}) {
    const LidarOptions o = lidar_model(name);
    const std::size_t at_once = covered_cells(o, 0.1), soon = covered_cells(o, 0.3), later = covered_cells(o, 1.0);
    EXPECT_GT(soon, at_once * 11 / 10) << name;
    EXPECT_GT(later, soon) << name;
    // Of the field of view: the ellipse of the Avia, 59 degrees all around of the Mid-360.
    const double all = std::string(name) == "avia" ? M_PI / 4 * 70.4 * 77.2 : 360.0 * 59.0;
    EXPECT_GT(static_cast<double>(later), 0.95 * all) << name;
    EXPECT_LT(static_cast<double>(at_once), 0.9 * all) << name;
  }
  const LidarOptions spinning = lidar_model("spinning_64");
  EXPECT_EQ(covered_cells(spinning, 0.1), covered_cells(spinning, 0.5)) << "every turn is the same";
}

TEST(LidarBeam, RosettesFillTheFieldOfViewOfTheDataSheet) {
  const auto extent = [](const LidarOptions& o) {
    Angles low{180, 90}, high{-180, -90};
    std::set<int> lines;
    for (double start = 0.0; start < 1.0; start += 0.1) {
      for (std::size_t i = 0; i < beams_per_scan(o); ++i) {
        const LidarBeam beam = lidar_beam(o, start, i);
        const Angles a = angles(beam.direction);
        low = {std::min(low.azimuth_deg, a.azimuth_deg), std::min(low.elevation_deg, a.elevation_deg)};
        high = {std::max(high.azimuth_deg, a.azimuth_deg), std::max(high.elevation_deg, a.elevation_deg)};
        lines.insert(beam.line);
      }
    }
    return std::tuple{low, high, lines.size()};
  };
  const auto [avia_low, avia_high, avia_lines] = extent(lidar_model("avia"));
  EXPECT_NEAR(avia_high.azimuth_deg - avia_low.azimuth_deg, 70.4, 0.5);
  EXPECT_NEAR(avia_high.elevation_deg - avia_low.elevation_deg, 77.2, 0.5);
  EXPECT_EQ(avia_lines, 6u);
  EXPECT_EQ(beams_per_scan(lidar_model("avia")), 24000u);
  const auto [mid_low, mid_high, mid_lines] = extent(lidar_model("mid360"));
  EXPECT_NEAR(mid_low.elevation_deg, -7.0, 0.1);
  EXPECT_NEAR(mid_high.elevation_deg, 52.0, 0.1);
  EXPECT_NEAR(mid_high.azimuth_deg - mid_low.azimuth_deg, 360.0, 0.5);
  EXPECT_EQ(mid_lines, 4u);
  EXPECT_EQ(beams_per_scan(lidar_model("mid360")), 20000u);
}

LidarOptions exact(const std::string& model) {
  LidarOptions o = lidar_model(model);
  o.range_noise_m = o.angular_noise_deg = 0.0;
  o.lossless = true;
  return o;
}

const Eigen::Isometry3d kT_imu_lidar = [] {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(0.1, -0.05, 0.2);
  T.linear() = Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  return T;
}();

TEST(SimulateScan, NoiseFreePointsLieOnTheSceneAtTheirOwnTimes) {
  const PoseSpline path = walk(4.0);
  const Scene scene = room();
  for (const char* model : {"spinning_16", "avia", "mid360"}) {
    const LidarScan scan = simulate_scan(scene, path, kT_imu_lidar, exact(model), 8.0, 1);
    ASSERT_EQ(scan.positions.size(), beams_per_scan(exact(model))) << "a closed room answers every shot";
    double at_own_time = 0.0, at_start = 0.0;
    for (std::size_t i = 0; i < scan.positions.size(); ++i) {
      const Eigen::Vector3d p = kT_imu_lidar * scan.positions[i].cast<double>();
      const double t = scan.timestamp_s + static_cast<double>(scan.time_s[i]);
      at_own_time = std::max(at_own_time, testing::distance_to_room(path.pose(t) * p));
      at_start = std::max(at_start, testing::distance_to_room(path.pose(scan.timestamp_s) * p));
    }
    EXPECT_LT(at_own_time, 1e-4) << model;
    EXPECT_GT(at_start, 0.1) << model << ": without that the test would prove nothing";
    EXPECT_TRUE(std::is_sorted(scan.time_s.begin(), scan.time_s.end()));
  }
}

TEST(SimulateScan, RangeNoiseHasItsStandardDeviation) {
  LidarOptions o = exact("spinning_16");
  const PoseSpline path = walk();
  const LidarScan ideal = simulate_scan(room(), path, kT_imu_lidar, o, 5.0, 1);
  o.range_noise_m = 0.03;
  const LidarScan noisy = simulate_scan(room(), path, kT_imu_lidar, o, 5.0, 1);
  ASSERT_EQ(noisy.positions.size(), ideal.positions.size());
  std::vector<double> errors;
  double mean = 0.0;
  for (std::size_t i = 0; i < ideal.positions.size(); ++i) {
    errors.push_back(static_cast<double>(noisy.positions[i].norm()) - static_cast<double>(ideal.positions[i].norm()));
    mean += errors.back() / static_cast<double>(ideal.positions.size());
    EXPECT_LT(noisy.positions[i].normalized().cross(ideal.positions[i].normalized()).norm(), 1e-5F);
  }
  EXPECT_NEAR(testing::rms(errors), 0.03, 0.05 * 0.03) << "28,800 draws: 0.4 % standard error";
  EXPECT_NEAR(mean, 0.0, 5 * 0.03 / std::sqrt(28800.0));
}

TEST(SimulateScan, AngularNoiseShowsAsRangeOnInclinedSurfaces) {
  // Straight ahead at the wall x = 20 from the origin, beams 45 degrees to the left: range = 16 / sin 45 deg (the wall
  // y = 16), range error = range * angle / tan 45 deg.
  LidarOptions o = exact("spinning_16");
  o.elevations_deg = {0.0};
  o.azimuth_steps = 36000;
  o.angular_noise_deg = 0.1;
  PathOptions still;
  still.hold_s = 1.0;
  const PoseSpline path = make_path({{0, 0, 2}}, still, 1);
  const LidarScan scan = simulate_scan(room(), path, Eigen::Isometry3d::Identity(), o, 0.0, 1);
  std::vector<double> errors;
  for (const Eigen::Vector3f& p : scan.positions) {
    const Angles a = angles(p.cast<double>().normalized());
    if (a.azimuth_deg < 52.0 || a.azimuth_deg > 62.0) continue;  // well inside of the wall y = 16
    const double bearing = a.azimuth_deg * M_PI / 180.0, range = 16.0 / std::sin(bearing);
    errors.push_back((static_cast<double>(p.norm()) - range) * std::tan(bearing) / range * 180.0 / M_PI);
  }
  ASSERT_GT(errors.size(), 900u);
  EXPECT_NEAR(testing::rms(errors), 0.1, 0.01) << "1000 draws: 2.3 % standard error";
}

TEST(SimulateScan, LossesFollowPowerAndRange) {
  PathOptions still;
  still.hold_s = 1.0;
  const PoseSpline path = make_path({{0, 0, 2}}, still, 1);
  const auto count = [&](const LidarOptions& o) {
    return simulate_scan(room(), path, Eigen::Isometry3d::Identity(), o, 0.0, 1).positions.size();
  };
  LidarOptions o = lidar_model("spinning_16");
  const auto all = static_cast<double>(beams_per_scan(o));
  EXPECT_GT(static_cast<double>(count(o)), 0.97 * all) << "a room, 100 m of range";
  o.lost_fraction = 0.25;
  EXPECT_NEAR(static_cast<double>(count(o)) / all, 0.75, 0.03);
  o = exact("spinning_16");
  o.min_range_m = 15.0;
  const LidarScan far = simulate_scan(room(), path, Eigen::Isometry3d::Identity(), o, 0.0, 1);
  o.min_range_m = 0.0;
  o.max_range_m = 15.0;
  const LidarScan near = simulate_scan(room(), path, Eigen::Isometry3d::Identity(), o, 0.0, 1);
  EXPECT_EQ(static_cast<double>(far.positions.size() + near.positions.size()), all) << "every shot is in one of both";
  for (const Eigen::Vector3f& p : near.positions) EXPECT_LE(p.norm(), 15.001F);
  // Dim echoes: walls 16 to 20 m away at half the detection range of 10 m lose more the more they are inclined.
  o = lidar_model("spinning_16");
  o.half_detection_range_m = 10.0;
  const LidarScan dim = simulate_scan(room(), path, Eigen::Isometry3d::Identity(), o, 0.0, 1);
  std::size_t head_on = 0, inclined = 0;
  for (const Eigen::Vector3f& p : dim.positions) {
    const double bearing = std::abs(angles(p.cast<double>()).azimuth_deg);
    head_on += std::abs(bearing - 90.0) < 10.0 ? 1 : 0;
    inclined += std::abs(bearing - 60.0) < 10.0 ? 1 : 0;
  }
  EXPECT_GT(head_on, inclined);
}

TEST(SimulateScan, SameForAnyNumberOfThreadsOtherForAnotherSeedOrScan) {
  const Scene scene = room();
  const PoseSpline path = walk();
  const LidarOptions o = lidar_model("mid360");
  const auto run = [&](int threads, double start_s, std::uint64_t seed) {
    const ExecutionScope limit({.threads = threads});
    return simulate_scan(scene, path, kT_imu_lidar, o, start_s, seed);
  };
  const LidarScan one = run(1, 4.0, 9), four = run(4, 4.0, 9);
  ASSERT_EQ(one.positions.size(), four.positions.size());
  EXPECT_EQ(one.positions, four.positions);
  EXPECT_EQ(one.intensity, four.intensity);
  EXPECT_EQ(one.time_s, four.time_s);
  EXPECT_EQ(one.ring, four.ring);
  EXPECT_NE(run(1, 4.0, 10).positions, one.positions);
  EXPECT_NE(run(1, 4.1, 9).positions, one.positions);
}

TEST(SimulateScan, RefusesWhatCannotBe) {
  LidarOptions o = lidar_model("mid360");
  const PoseSpline path = walk();
  EXPECT_THROW(simulate_scan(room(), path, kT_imu_lidar, o, path.end_s() - 0.01, 1), std::out_of_range);
  o.max_range_m = 0.0;
  EXPECT_THROW(simulate_scan(room(), path, kT_imu_lidar, o, 1.0, 1), UsageError);
  EXPECT_THROW(lidar_model("hesai"), UsageError);
}

}  // namespace lidar_test
}  // namespace cmap
