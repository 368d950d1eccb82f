#include "cmap/sim/scene.hpp"

#include <cmath>
#include <limits>

#include "cmap/core/execution.hpp"
#include "sim/sim_testing.hpp"

namespace cmap {
namespace scene_test {

using testing::aerial;
using testing::indoor;
using testing::TempFolder;
using testing::town;
using testing::uniform;

/// The slab method (Kay and Kajiya 1986) as the oracle.
std::optional<double> box_distance(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                   const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double near = 0.0, far = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - origin[axis]) / direction[axis], b = (high[axis] - origin[axis]) / direction[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  if (near > far) return std::nullopt;
  return near > 0.0 ? near : far;
}

/// Rays from all around and from inside, at UTM coordinates.
TEST(Cast, MeetsABoxWhereTheSlabMethodDoes) {
  const TempFolder folder;
  const Eigen::Vector3d low(500000.25, 4649776.5, 100.125), high = low + Eigen::Vector3d(3.0, 5.0, 2.0);
  const Scene scene = read_mesh_scene(folder.write("box.obj", testing::box_obj(low, high)));
  std::mt19937_64 random(3);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    Eigen::Vector3d origin, direction;
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis] = 0.5 * (low[axis] + high[axis]) + uniform(random, -6.0, 6.0);
      direction[axis] = uniform(random, -1.0, 1.0);
    }
    direction.normalize();
    const auto expected = box_distance(low, high, origin, direction);
    // A ray that grazes an edge may pass it on either side.
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(1e-5);
    const auto larger = box_distance(low - margin, high + margin, origin, direction);
    const auto smaller = box_distance(low + margin, high - margin, origin, direction);
    if (larger.has_value() != smaller.has_value()) continue;
    const auto hit = scene.cast(origin, direction, 100.0);
    ASSERT_EQ(expected.has_value(), hit.has_value());
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(*expected, hit->distance_m, 1e-6);  // the box is exact in float relative to the scene's origin
    EXPECT_LE(hit->normal.cast<double>().dot(direction), 0.0);
    EXPECT_NEAR(1.0, hit->normal.cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_NEAR(0.5, hit->color[0], 1e-6);
    const auto probed = scene.probe(origin, direction, 100.0);
    ASSERT_TRUE(probed);
    EXPECT_EQ(hit->distance_m, probed->distance_m);
  }
  EXPECT_GT(hits, 1000);
}

TEST(Cast, EndsAtTheLargestDistance) {
  const TempFolder folder;
  const Scene scene = read_mesh_scene(folder.write("box.obj", testing::box_obj({0, 0, 0}, {1, 1, 1})));
  EXPECT_TRUE(scene.cast({0.3, 0.4, 3.0}, {0, 0, -1}, 2.001));
  EXPECT_FALSE(scene.cast({0.3, 0.4, 3.0}, {0, 0, -1}, 1.999));
  EXPECT_FALSE(scene.cast({0.3, 0.4, 3.0}, {0, 0, 1}, 1e3));
}

TEST(Cast, ColorDoesNotDependOnTheView) {
  std::mt19937_64 random(5);
  int compared = 0, equal = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d eye(uniform(random, -60, 60), -30.5, 2.5),
        other(eye.x() + uniform(random, -2, 2), -29.0, 1.5);
    const Eigen::Vector3d to =
        Eigen::Vector3d(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -0.6, 0.3)).normalized();
    const auto hit = town().cast(eye, to, 50.0);
    if (!hit) continue;
    const Eigen::Vector3d point = eye + hit->distance_m * to, ray = point - other;
    const auto again = town().cast(other, ray.normalized(), 60.0);
    if (!again || std::abs(again->distance_m - ray.norm()) > 1e-4 || again->normal.dot(hit->normal) < 0.999F) continue;
    ++compared;
    const float difference = std::abs(again->color[0] - hit->color[0]) + std::abs(again->color[1] - hit->color[1]);
    equal += difference < 2.0F / 255.0F ? 1 : 0;
  }
  ASSERT_GT(compared, 1000);
  // Rounding moves the point by some 1e-5 m: across the edge of a shadow or a brick now and then.
  EXPECT_GT(equal, 0.99 * compared);
}

class EveryScene : public ::testing::TestWithParam<const Scene* (*)()> {};
INSTANTIATE_TEST_SUITE_P(Sim, EveryScene,
                         ::testing::Values([] { return &town(); }, [] { return &indoor(); }, [] { return &aerial(); }));

TEST_P(EveryScene, RoutesAreFreeAndFineEnough) {
  const Scene& scene = *GetParam()();
  ASSERT_FALSE(scene.routes().empty());
  for (const SceneRoute& route : scene.routes()) {
    EXPECT_EQ(&route, &scene.route(route.name));
    const std::size_t n = route.points.size();
    ASSERT_GT(n, 20U);
    for (std::size_t i = 0; i + 1 < n || (route.closed && i < n); ++i) {
      const Eigen::Vector3d from = route.points[i] + Eigen::Vector3d(0, 0, 1.5),
                            step = route.points[(i + 1) % n] + Eigen::Vector3d(0, 0, 1.5) - from;
      EXPECT_LE(step.norm(), 1.0) << route.name << " " << i;
      ASSERT_GT(step.norm(), 0.0) << route.name << " " << i;
      EXPECT_FALSE(scene.probe(from, step.normalized(), step.norm())) << route.name << " " << i;
      // Half a meter to both sides too.
      const Eigen::Vector3d left = Eigen::Vector3d(-step.y(), step.x(), 0.0).normalized();
      EXPECT_FALSE(scene.probe(from, left, 0.5)) << route.name << " " << i;
      EXPECT_FALSE(scene.probe(from, -left, 0.5)) << route.name << " " << i;
    }
  }
}

TEST_P(EveryScene, GroundIsWhereRaysMeetIt) {
  const Scene& scene = *GetParam()();
  const SceneRoute& route = scene.routes().front();
  for (const Eigen::Vector3d& p : route.points) {
    const double ground = scene.ground_height_m(p.x(), p.y());
    if (scene.bounds().max.z() < p.z()) break;  // a survey: trees hide the ground below
    const auto hit = scene.probe({p.x(), p.y(), ground + 2.2}, -Eigen::Vector3d::UnitZ(), 10.0);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(2.2, hit->distance_m, 0.02);  // the mesh is linear between heights 1 m apart
  }
}

TEST_P(EveryScene, IsTheSameForTheSameSeed) {
  const Scene& scene = *GetParam()();
  const PointCloud a = sample_surface(scene, 0.3, 7), other_seed = sample_surface(scene, 0.3, 8);
  PointCloud b;
  {
    const ExecutionScope one({.threads = 1});
    b = sample_surface(scene, 0.3, 7);
  }
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(a.positions == b.positions);
  EXPECT_TRUE(std::get<Array<Rgb8>>(a.colors) == std::get<Array<Rgb8>>(b.colors));
  EXPECT_FALSE(a.positions == other_seed.positions);
}

TEST(Scenes, FollowTheirSeedAndOptions) {
  TownOptions options;
  options.trees_per_100m = 1.0;
  const PointCloud a = sample_surface(make_town(options), 0.05, 1), b = sample_surface(make_town(options), 0.05, 1);
  EXPECT_TRUE(a.positions == b.positions);
  options.seed = 2;
  EXPECT_FALSE(sample_surface(make_town(options), 0.05, 1).positions == a.positions);
  EXPECT_GT(make_indoor({.length_m = 50.0}).bounds().max.x(), 24.9);
}

TEST(Scenes, RefuseOptionsOutOfRange) {
  using ::testing::HasSubstr;
  using ::testing::ThrowsMessage;
  EXPECT_THAT([] { make_town({.blocks_x = 2}); }, ThrowsMessage<UsageError>(HasSubstr("blocks_x is 2")));
  EXPECT_THAT([] { make_town({.undulation_m = std::nan("")}); },
              ThrowsMessage<UsageError>(HasSubstr("undulation_m is nan")));
  EXPECT_THAT([] { make_indoor({.width_m = 17.0}); }, ThrowsMessage<UsageError>(HasSubstr("width_m is 17")));
  EXPECT_THAT([] { make_aerial({.buildings = -1}); }, ThrowsMessage<UsageError>(HasSubstr("buildings is -1")));
  EXPECT_THAT([] { indoor().route("street"); }, ThrowsMessage<UsageError>(HasSubstr("it has: corridor_loop")));
}

TEST(Aerial, WaterIsSeenButReturnsNothing) {
  int water = 0, land = 0;
  for (double x = -200.0; x < 200.0; x += 5.0) {
    for (double y = -100.0; y < 125.0; y += 5.0) {
      const auto hit = aerial().cast({x, y, 100.0}, -Eigen::Vector3d::UnitZ(), 300.0);
      ASSERT_TRUE(hit);
      EXPECT_GT(hit->color[2], 0.0F);
      (hit->reflectivity == 0.0F ? water : land) += 1;
    }
  }
  EXPECT_GT(water, 100);
  EXPECT_GT(land, 1000);
}

/// Luminance of 1.9 x 1.9 m of ground, 20 x 20 points, seen from `above`.
std::vector<double> patch(const Scene& scene, double x, double y, double above) {
  std::vector<double> values;
  const double z = scene.ground_height_m(x, y) + above;
  for (int i = 0; i < 400; ++i) {
    const auto hit = scene.cast({x + 0.095 * (i % 20), y + 0.095 * (i / 20), z}, -Eigen::Vector3d::UnitZ(), 100.0);
    values.push_back(hit ? 0.3 * hit->color[0] + 0.6 * hit->color[1] + 0.1 * hit->color[2] : 0.0);
  }
  return values;
}

/// Shifts the mean to 0 and scales to length 1; returns the standard deviation it had.
double normalize(std::vector<double>& values) {
  double mean = 0.0, squares = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (double& v : values) {
    v -= mean;
    squares += v * v;
  }
  for (double& v : values) v /= std::sqrt(std::max(squares, 1e-300));
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST_P(EveryScene, NoTwoPatchesOfGroundLookAlike) {
  const Scene& scene = *GetParam()();
  std::vector<std::vector<double>> patches;
  const auto& points = scene.routes().front().points;
  for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(6, points.size() / 120)) {
    // Beside the line in the middle of a road, which repeats by its nature.
    patches.push_back(patch(scene, points[i].x() + 0.1, points[i].y() + 0.1, 2.0));
  }
  int flat = 0;
  for (auto& p : patches) flat += normalize(p) < 0.015 ? 1 : 0;
  EXPECT_LE(flat, 0.03 * static_cast<double>(patches.size()));  // 0.015: 4 of 255, what a camera's noise does not hide
  for (std::size_t i = 0; i < patches.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double correlation = 0.0;
      for (std::size_t k = 0; k < 400; ++k) correlation += patches[i][k] * patches[j][k];
      EXPECT_LT(correlation, 0.9) << i << " " << j;
    }
  }
}

}  // namespace scene_test
}  // namespace cmap
