// One pair of maps, far from zero and near it, from integers, floats and doubles: FORMATS, "Units and large
// coordinates".

#include <Eigen/Geometry>
#include <cstring>
#include <numbers>
#include <random>

#include "conformance/real_maps.hpp"
#include "io/io_testing.hpp"
#include "spatial/clouds.hpp"

namespace cmap::test {
namespace large_coordinates_test {

namespace fs = std::filesystem;

const Eigen::Vector3d kShift_m(5e5, 4e6, 100);

/// A cloud's points, moved by a shift and written as doubles by nobody's code but this.
fs::path write_double_ply(const fs::path& path, const std::vector<Eigen::Vector3d>& points, const Colors& colors) {
  const bool wide = std::holds_alternative<Array<Rgb16>>(colors);
  const char* type = wide ? "ushort" : "uchar";
  testing::Bytes bytes("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size()) +
                       "\nproperty double x\nproperty double y\nproperty double z\n");
  for (const char* channel : {"red", "green", "blue"})
    bytes.text(std::string("property ") + type + " " + channel + "\n");
  bytes.text("end_header\n");
  for (std::size_t i = 0; i < points.size(); ++i) {
    bytes.put(points[i].x(), points[i].y(), points[i].z());
    for (std::size_t c = 0; c < 3; ++c) {
      if (wide)
        bytes.put(std::get<Array<Rgb16>>(colors)[i][c]);
      else
        bytes.put(std::get<Array<Rgb8>>(colors)[i][c]);
    }
  }
  std::ofstream(path, std::ios::binary) << bytes.str();
  return path;
}

std::vector<Eigen::Vector3d> shifted_points(const PointCloud& cloud, const Eigen::Vector3d& shift_m) {
  std::vector<Eigen::Vector3d> points(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) points[i] = cloud.world(i) + shift_m;
  return points;
}

/// The pair read from files of doubles.
Pair through_double_ply(const Pair& pair, const Eigen::Vector3d& shift_m) {
  const testing::TempFolder folder;
  return {
      read_point_cloud(
          write_double_ply(folder / "r.ply", shifted_points(pair.reference, shift_m), pair.reference.colors))
          .cloud,
      read_point_cloud(write_double_ply(folder / "e.ply", shifted_points(pair.estimate, shift_m), pair.estimate.colors))
          .cloud};
}

Pair with_moved_origin(Pair pair, const Eigen::Vector3d& shift_m) {
  pair.reference.origin += shift_m;
  pair.estimate.origin += shift_m;
  return pair;
}

/// FORMATS, "Units and large coordinates".
constexpr test::Tolerance kSamePlaceElsewhere{1e-6, 1e-12};

void expect_same_scores(const Pair& pair, const Pair& other, const Json& config, const std::string& title) {
  test::WorstDifferences worst;
  const Evaluation expected = evaluate(pair.reference, pair.estimate, options_of(config));
  const Evaluation found = evaluate(other.reference, other.estimate, options_of(config));
  for (const Warning& warning : found.warnings) EXPECT_NE(warning.id, "precision_reduced");
  test::expect_same_records(expected, found, kSamePlaceElsewhere, worst);
  worst.print(title);
}

Json shifted_tum_options() {
  Json config = kTumOptions;
  config["as"] = Json::array();
  config["ccs-voxel"] = 0.25;
  config["awd-voxel"] = 4;
  return config;
}

TEST(LargeCoordinates, TumFr1ScoresTheSameFarAway) {
  SKIP_WITHOUT(shared_folder() / "data/tum_fr1");
  const Pair pair = read_tum();
  expect_same_scores(pair, with_moved_origin(pair, kShift_m), shifted_tum_options(), "tum_fr1 on a far origin");
  expect_same_scores(pair, through_double_ply(pair, kShift_m), shifted_tum_options(), "tum_fr1 far away, from doubles");
}

const Json kStadiumOptions{{"metrics", {"color+", "geometry", "distribution", "mme"}},
                           {"thresholds", {1.0, 0.5, 0.2, 0.1}},
                           {"ccs-voxel", 0.25},
                           {"awd-voxel", 4},
                           {"awd-min-points", 20},
                           {"mme-radius", 2.0}};

fs::path stadium_path() { return shared_folder() / "data/autzen/stadium_utm.las"; }

double gaussian(std::mt19937_64& random) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += test::uniform(random);
  return sum;
}

/// The stadium turned by half a degree about its center, shifted by 15 cm, with 5 cm noise, a tenth of the points
/// missing and darker colors.
PointCloud disturbed(const PointCloud& cloud) {
  const Box3d box = bounds(cloud);
  const Eigen::Vector3d center = 0.5 * (box.min + box.max);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.5 * std::numbers::pi / 180.0, Eigen::Vector3d(0.1, 0.2, 1.0).normalized()).toRotationMatrix();
  std::mt19937_64 random(1);
  PointCloud result;
  result.origin = cloud.origin;
  Array<Rgb16> colors;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (test::uniform(random) < 0.1) continue;
    const double nx = gaussian(random), ny = gaussian(random), nz = gaussian(random);
    const Eigen::Vector3d world =
        R * (cloud.world(i) - center) + center + Eigen::Vector3d(0.1, 0.1, 0.05) + 0.05 * Eigen::Vector3d(nx, ny, nz);
    result.positions.push_back((world - cloud.origin).cast<float>());
    Rgb16 color = std::get<Array<Rgb16>>(cloud.colors)[i];
    for (std::uint16_t& channel : color)
      channel = static_cast<std::uint16_t>(0.85 * channel + 2000.0 * test::uniform(random));
    colors.push_back(color);
  }
  result.colors = colors;
  return result;
}

template <class T>
T field(const std::string& bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof(T));
  return value;
}

/// The coordinates of a LAS 1.2 file by the specification: integers times scale plus offset.
std::vector<Eigen::Vector3d> las_points(const fs::path& path) {
  const std::string bytes = testing::read_bytes(path);
  const auto first = field<std::uint32_t>(bytes, 96);
  const auto record_bytes = field<std::uint16_t>(bytes, 105);
  std::vector<Eigen::Vector3d> points(field<std::uint32_t>(bytes, 107));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto raw = field<std::int32_t>(bytes, first + i * record_bytes + 4 * axis);
      points[i][static_cast<Eigen::Index>(axis)] =
          raw * field<double>(bytes, 131 + 8 * axis) + field<double>(bytes, 155 + 8 * axis);
    }
  }
  return points;
}

TEST(LargeCoordinates, LasAndDoublePlyScoreTheSame) {
  SKIP_WITHOUT(stadium_path());
  const PointCloud las = read_point_cloud(stadium_path()).cloud;
  const PointCloud estimate = disturbed(las);
  const testing::TempFolder folder;
  write_ply(folder / "written.ply", las);
  const PointCloud written = read_point_cloud(folder / "written.ply").cloud;
  expect_same_scores({las, estimate}, {written, estimate}, kStadiumOptions, "stadium, LAS and write_ply");

  const PointCloud by_hand =
      read_point_cloud(write_double_ply(folder / "hand.ply", las_points(stadium_path()), las.colors)).cloud;
  expect_same_scores({las, estimate}, {by_hand, estimate}, kStadiumOptions, "stadium, LAS and doubles by hand");
}

TEST(LargeCoordinates, TheStadiumScoresTheSameFarAway) {
  SKIP_WITHOUT(stadium_path());
  const PointCloud las = read_point_cloud(stadium_path()).cloud;
  const Pair pair{las, disturbed(las)};
  expect_same_scores(pair, with_moved_origin(pair, kShift_m), kStadiumOptions, "stadium on a farther origin");
  expect_same_scores(pair, through_double_ply(pair, kShift_m), kStadiumOptions, "stadium farther away, from doubles");
}

}  // namespace large_coordinates_test
}  // namespace cmap::test
