#include "cmap/align/umeyama.hpp"

#include "align/align_testing.hpp"
#include "cmap/core/execution.hpp"

namespace cmap {
namespace umeyama_test {

using ::testing::HasSubstr;
using Points = std::vector<Eigen::Vector3d>;

Points random_points(std::size_t n, unsigned seed, double reach = 10.0) {
  std::mt19937_64 random(seed);
  Points points;
  for (std::size_t i = 0; i < n; ++i) points.push_back(test::random_vector(random, reach));
  return points;
}

Points moved(const Points& points, const Similarity& T, double noise_m = 0.0, unsigned seed = 99) {
  std::mt19937_64 random(seed);
  Points result;
  for (const auto& p : points) result.push_back(T * p + test::random_vector(random, noise_m));
  return result;
}

PairMoments moments_of(const Points& p, const Points& q) {
  return pair_moments(p.size(), [&](std::size_t i) { return WeightedPair{p[i], q[i], 1.0}; });
}

TEST(Umeyama, ByHand) {
  // A quarter turn about z, doubled, moved by (1, 2, 3).
  const Points p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Points q{{1, 2, 3}, {1, 4, 3}, {-1, 2, 3}};
  const Similarity T = umeyama(p, q);
  EXPECT_NEAR(T.scale, 2.0, 1e-14);
  EXPECT_TRUE(T.translation.isApprox(Eigen::Vector3d(1, 2, 3), 1e-14));
  EXPECT_TRUE((T * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(1, 2, 5), 1e-14));
}

TEST(Umeyama, AMirrorImageInAPlaneIsATurnInSpace) {
  // Umeyama's own example, section IV, is planar; in space it is the turn by pi about y, without error.
  const Points p{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  const Points q{{0, 0, 0}, {-1, 0, 0}, {0, 2, 0}};
  EXPECT_TRUE(umeyama(p, q).rotation.isApprox(Eigen::Vector3d(-1, 1, -1).asDiagonal().toDenseMatrix(), 1e-14));
}

TEST(Umeyama, AMirrorImageInSpaceGivesARotation) {
  const Points p{{0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 1}};
  Points q = p;
  for (auto& x : q) x.x() = -x.x();
  EXPECT_NEAR(umeyama(p, q).rotation.determinant(), 1.0, 1e-14);
}

TEST(Umeyama, RecoversSimilaritiesExactly) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Similarity truth = test::random_similarity(random, 0.1, 10.0, 100.0);
    const Points p = random_points(20, 100 + static_cast<unsigned>(trial));
    const Similarity T = umeyama(p, moved(p, truth));
    EXPECT_NEAR(T.scale, truth.scale, 1e-12 * truth.scale);
    EXPECT_TRUE(T.matrix().isApprox(truth.matrix(), 1e-12));
  }
}

TEST(Umeyama, RigidKeepsTheScale) {
  std::mt19937_64 random(2);
  const Similarity truth = test::random_similarity(random, 2.0, 2.0, 5.0);
  const Points p = random_points(30, 3);
  const Similarity T = umeyama(p, moved(p, truth), ScaleModel::rigid());
  EXPECT_EQ(T.scale, 1.0);
  EXPECT_TRUE(T.rotation.isApprox(truth.rotation, 1e-12));
}

TEST(Umeyama, PrecisionAtUtmCoordinates) {
  std::mt19937_64 random(4);
  const Points p = random_points(50, 5, 100.0);
  Points q = moved(p, {1.1, test::random_rotation(random), {0, 0, 0}});
  const Eigen::Vector3d utm(5e5, 4e6, 100);
  for (auto& x : q) x += utm;
  const Similarity T = umeyama(p, q);
  // Coordinates of 4e6 m carry 5e-10 m; 50 points of 100 m average below that.
  EXPECT_NEAR(T.scale, 1.1, 1e-11);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_LT((T * p[i] - q[i]).norm(), 2e-9);
}

TEST(Umeyama, RegularizedScaleByHand) {
  // Points at +-1 on the axes: sum |p~|^2 = 6, q = 2 p: tr(R H) = 12; lambda = 3, s0 = 1: (12 + 3) / (6 + 3) = 5/3.
  Points p;
  for (int axis = 0; axis < 3; ++axis) {
    for (double sign : {-1.0, 1.0}) p.push_back(sign * Eigen::Vector3d::Unit(axis));
  }
  Points q;
  for (const auto& x : p) q.emplace_back(2.0 * x + Eigen::Vector3d(7, 8, 9));
  const Similarity T = umeyama(p, q, {true, 1.0, 3.0});
  EXPECT_NEAR(T.scale, 5.0 / 3.0, 1e-14);
  EXPECT_TRUE(T.translation.isApprox(Eigen::Vector3d(7, 8, 9), 1e-14));
}

TEST(Umeyama, NoPerturbationHasALowerCost) {
  std::mt19937_64 random(6);
  const Points p = random_points(40, 7);
  const Points q = moved(p, test::random_similarity(random, 0.8, 1.3, 50.0), 0.5);
  const PairMoments moments = moments_of(p, q);
  for (const double lambda : {0.0, 1.0, 1e4}) {
    const ScaleModel model{true, 0.9, lambda};
    const Similarity best = fit_similarity(moments, model);
    const double lowest = similarity_cost(moments, model, best);
    for (int trial = 0; trial < 20000; ++trial) {
      const double size = std::pow(10.0, test::uniform_in(random, -4.0, 0.0));
      Similarity other = best;
      other.scale *= 1.0 + size * test::uniform_in(random, -0.5, 0.5);
      other.rotation = rotation_from(test::random_vector(random, size)) * other.rotation;
      other.translation += test::random_vector(random, size);
      // The cost is a difference of sums of about 1e5 m^2: 1e-15 of that each.
      ASSERT_GE(similarity_cost(moments, model, other), lowest - 1e-9);
    }
  }
}

/// The paper's steps on points that are not centered: s for the present R and t, then R and t for that s.
Similarity alternate(const PairMoments& m, const ScaleModel& model, int steps) {
  Similarity T = fit_similarity(m, {false, model.s0, 0.0});
  const double sum_sq_p = m.scatter_p.trace() + m.weight * m.mean_p.squaredNorm();
  for (int i = 0; i < steps; ++i) {
    const double sum_q_Rp =
        (T.rotation * m.cross).trace() + m.weight * (m.mean_q - T.translation).dot(T.rotation * m.mean_p);
    T.scale = (sum_q_Rp + model.lambda_m2 * model.s0) / (sum_sq_p + model.lambda_m2);
    T.translation = m.mean_q - T.scale * (T.rotation * m.mean_p);
  }
  return T;
}

TEST(Umeyama, TheAlternationOfThePaperEndsAtTheSamePoint) {
  std::mt19937_64 random(8);
  Points p = random_points(60, 9, 25.0);
  for (auto& x : p) x += Eigen::Vector3d(30, -20, 5);
  const Points q = moved(p, test::random_similarity(random, 1.03, 1.03, 10.0), 0.3);
  const PairMoments moments = moments_of(p, q);
  for (const double lambda : {0.0, 0.1 * 60 * 75 * 75}) {
    const ScaleModel model{true, 1.0, lambda};
    const Similarity closed = fit_similarity(moments, model);
    EXPECT_NEAR(alternate(moments, model, 1000).scale, closed.scale, 1e-12);
    EXPECT_GT(std::abs(alternate(moments, model, 1).scale - closed.scale), 1e-4) << "one step is not there yet";
  }
}

TEST(Umeyama, StrengthOfTheRegularization) {
  // Notes 9.2: for a uniform box the share of the least-squares step is 1 / (1 + 12 beta) with lambda = beta n D^2.
  const Points p = random_points(20000, 10, 1.0);
  const Similarity truth{1.1, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  const PairMoments moments = moments_of(p, moved(p, truth));
  const double sq_diagonal = 12.0;  // of a cube of side 2
  for (const double beta : {1.0, 0.1, 0.01}) {
    const double lambda = beta * 20000 * sq_diagonal;
    const double share = (fit_similarity(moments, {true, 1.0, lambda}).scale - 1.0) / 0.1;
    EXPECT_NEAR(share, 1.0 / (1.0 + 12.0 * beta), 0.01) << "20000 samples of a variance: 1 %";
  }
}

TEST(Umeyama, Equivariant) {
  std::mt19937_64 random(11);
  const Points p = random_points(25, 12);
  const Points q = moved(p, test::random_similarity(random, 0.9, 1.2, 5.0), 0.2);
  const Similarity before = umeyama(p, q, ScaleModel::rigid());
  const Similarity A{1.0, test::random_rotation(random), {1, 2, 3}};
  const Similarity B{1.0, test::random_rotation(random), {-4, 5, 6}};
  const Similarity after = umeyama(moved(p, A), moved(q, B), ScaleModel::rigid());
  EXPECT_TRUE(after.matrix().isApprox((B * before * A.inverse()).matrix(), 1e-12));
  const Similarity back = umeyama(q, p, ScaleModel::rigid());
  EXPECT_TRUE(back.matrix().isApprox(before.inverse().matrix(), 1e-12)) << "rigid fits are symmetric in the two lists";
}

TEST(Umeyama, WeightsCountLikeCopies) {
  Points p = random_points(10, 13), q = moved(p, {1.0, Eigen::Matrix3d::Identity(), {1, 0, 0}}, 0.5);
  std::vector<double> weights(10, 1.0);
  weights[3] = 3.0;
  weights[7] = 0.0;
  const Similarity weighted = umeyama(p, q, ScaleModel::free(), weights);
  p.push_back(p[3]), p.push_back(p[3]), p.erase(p.begin() + 7);
  q.push_back(q[3]), q.push_back(q[3]), q.erase(q.begin() + 7);
  EXPECT_TRUE(weighted.matrix().isApprox(umeyama(p, q).matrix(), 1e-12));
}

TEST(Umeyama, PlanarPointsAreEnough) {
  std::mt19937_64 random(14);
  Points p = random_points(20, 15);
  for (auto& x : p) x.z() = 2.0;
  const Similarity truth = test::random_similarity(random, 0.5, 2.0, 10.0);
  EXPECT_TRUE(umeyama(p, moved(p, truth)).matrix().isApprox(truth.matrix(), 1e-12));
}

TEST(Umeyama, RefusesWhatIsNotDetermined) {
  const Points line{{1, 1, 0}, {2, 2, 0}, {5, 5, 0}, {-3, -3, 0}};
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { umeyama(line, line); }),
              HasSubstr("collinear: the rotation about (0.71, 0.71, 0.00) is not determined"));
  const Points same(5, Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { umeyama(same, same); }), HasSubstr("coincide"));
  const Points two{{0, 0, 0}, {1, 0, 0}};
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { umeyama(two, two); }), HasSubstr("2 pairs"));
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { umeyama({}, {}); }), HasSubstr("0 pairs"));
  // A spread source on a collinear target.
  const Points p{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Points on_line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { umeyama(p, on_line); }),
              HasSubstr("do not determine the rotation"));
}

TEST(Umeyama, RefusesWrongArguments) {
  const Points p = random_points(4, 16);
  EXPECT_THROW(umeyama(p, random_points(5, 17)), std::invalid_argument);
  const std::vector<double> negative{1, 1, -1, 1};
  EXPECT_THROW(umeyama(p, p, ScaleModel::free(), negative), std::invalid_argument);
}

TEST(Umeyama, TheSameForAnyNumberOfThreads) {
  const Points p = random_points(50000, 18), q = moved(p, {}, 0.1);
  const Similarity all = umeyama(p, q);
  const ExecutionScope one({.threads = 1});
  EXPECT_EQ(umeyama(p, q).matrix(), all.matrix());
}

TEST(SimilarityTest, ComposesAndInverts) {
  std::mt19937_64 random(19);
  const Similarity a = test::random_similarity(random, 0.5, 2.0, 5.0),
                   b = test::random_similarity(random, 0.5, 2.0, 5.0);
  const Eigen::Vector3d x(1, -2, 3);
  EXPECT_TRUE(((a * b) * x).isApprox(a * (b * x), 1e-14));
  EXPECT_TRUE((a.inverse() * (a * x)).isApprox(x, 1e-14));
  EXPECT_TRUE((a * b).matrix().isApprox(a.matrix() * b.matrix(), 1e-14));
  EXPECT_TRUE(similarity_from(a.matrix()).matrix().isApprox(a.matrix(), 1e-14));
}

TEST(ReflectionCost, IsZeroOfAMirrorImageAndTheFitsOwnOfFlatPoints) {
  std::mt19937_64 random(1);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Similarity T = test::random_similarity(random, 0.5, 2.0, 5.0);
    const Points p = random_points(50, seed);
    Points mirrored = p, flat = p;
    for (auto& x : mirrored) x.y() *= -1.0;
    for (auto& x : flat) x.z() = 0.0;
    const PairMoments image = moments_of(mirrored, moved(p, T));
    EXPECT_LT(reflection_cost(image, true), 1e-12 * image.sq_q);
    EXPECT_GT(reflection_cost(moments_of(p, moved(p, T)), true), 0.1 * image.sq_q) << "of no image";
    const PairMoments plane = moments_of(flat, moved(flat, T, 0.1, seed));
    const double fit = similarity_cost(plane, ScaleModel::free(), fit_similarity(plane, ScaleModel::free()));
    EXPECT_NEAR(reflection_cost(plane, true), fit, 1e-9 * plane.sq_q);
  }
}

TEST(SimilarityTest, RefusesOtherMatrices) {
  Eigen::Matrix4d mirror = Eigen::Matrix4d::Identity();
  mirror(0, 0) = -1.0;
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { similarity_from(mirror); }),
              HasSubstr("no rotation times a positive scale"));
  Eigen::Matrix4d shear = Eigen::Matrix4d::Identity();
  shear(0, 1) = 0.1;
  EXPECT_THAT(test::refusal_of<UnsupportedError>([&] { similarity_from(shear); }), HasSubstr("deviates by"));
}

}  // namespace umeyama_test
}  // namespace cmap
