#include "cmap/align/global.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cmap/align/icp.hpp"
#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "compatibility.hpp"
#include "features.hpp"
#include "registration_cloud.hpp"

namespace cmap {
namespace {

constexpr double kCoarseVoxelsPerSize = 100.0;
constexpr double kFeatureVoxels = 5.0;    ///< radius of the features
constexpr double kToleranceVoxels = 1.5;  ///< of matched points, each up to a voxel off
constexpr std::size_t kNormalNeighbors = 15;
constexpr std::size_t kHypotheses = 8;  ///< compared by overlap, for each way of matching
constexpr int kLevels = 4;              ///< of the refinement

PairMoments spread_of(const PointCloud& cloud) {
  return pair_moments(cloud.size(), [&](std::size_t i) {
    const Eigen::Vector3d p = cloud.positions[i].cast<double>();
    return WeightedPair{p, p, 1.0};
  });
}

/// What a box with the same spread would have as its diagonal: blind to a few strays.
double size_of(const PointCloud& cloud) {
  const PairMoments spread = spread_of(cloud);
  return std::sqrt(12.0 * spread.scatter_p.trace() / spread.weight);
}

/// A thinned cloud with its features; the first search index serves the comparison of hypotheses too.
struct FeatureCloud {
  FeatureCloud(const PointCloud& cloud, double voxel_m)
      : thinned(thinned_to(cloud, voxel_m)), target(thinned, kNormalNeighbors) {
    target.surface.fit_all();
    const PointBlocks& points = target.index.points;
    std::vector<Eigen::Vector3f> positions;
    for (std::size_t slot = 0; slot < points.size; ++slot) positions.push_back(points.offset(slot));
    const std::vector<Eigen::Vector3f> normals = oriented_normals();
    features = fpfh_features(positions, normals, kFeatureVoxels * voxel_m);
  }

  PointCloud thinned;
  RegistrationTarget target;
  Array<Fpfh> features;  ///< by slot

 private:
  /// Normals that look toward a point above the cloud's middle, so that copies that are turned agree. "Above" is along
  /// the direction of least spread; which of the two sides is tried out by the caller.
  std::vector<Eigen::Vector3f> oriented_normals() const {
    const PairMoments spread = spread_of(thinned);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread.scatter_p);
    const double height_m = 2.0 * std::sqrt(eigen.eigenvalues()[2] / spread.weight);
    const Eigen::Vector3d up = upward(eigen.eigenvectors().col(0), spread.mean_p);
    const Eigen::Vector3d eye = spread.mean_p + height_m * up;
    std::vector<Eigen::Vector3f> normals;
    for (std::size_t slot = 0; slot < target.index.points.size; ++slot) {
      const Eigen::Vector3d normal = target.surface.normal(slot);
      const double side = (eye - target.index.points.offset(slot).cast<double>()).dot(normal);
      normals.push_back((side < 0.0 ? -1.0f : 1.0f) * normal.cast<float>());
    }
    return normals;
  }

  /// The side of the longer tail: houses and trees stand on the ground.
  Eigen::Vector3d upward(const Eigen::Vector3d& axis, const Eigen::Vector3d& mean) const {
    double third_moment = 0.0;
    for (const Eigen::Vector3f& p : thinned.positions) {
      const double h = axis.dot(p.cast<double>() - mean);
      third_moment += h * h * h;
    }
    return third_moment < 0.0 ? (-axis).eval() : axis;
  }
};

struct Candidate {
  Similarity local;
  double score = -1.0;
};

/// Mean over both directions of max(0, 1 - (d / reach)^2): overlap that also counts how near. Both directions, because
/// one alone prefers to shrink.
double overlap_score(FeatureCloud& source, FeatureCloud& target, const Similarity& local, double reach_m) {
  const auto one_way = [](const NearestField& field, double reach) {
    double sum = 0.0;
    for (const double sq_dist : field.sq_dist) sum += std::max(0.0, 1.0 - sq_dist / (reach * reach));
    return sum / static_cast<double>(field.sq_dist.size());
  };
  MovingSource there(source.thinned), back(target.thinned);
  return 0.5 * (one_way(there.nearest(target.target.index, local), reach_m) +
                one_way(back.nearest(source.target.index, local.inverse()), reach_m / local.scale));
}

class Matcher {
 public:
  Matcher(FeatureCloud& source, FeatureCloud& target, double voxel_m, const GlobalOptions& options)
      : source_(source), target_(target), voxel_m_(voxel_m), options_(options) {}

  /// Compares the hypotheses of one way of matching with the best so far. `scale`: the source's features were computed
  /// for it.
  void try_features(const Array<Fpfh>& source_features, double scale, std::vector<Candidate>& candidates) {
    std::vector<FeatureMatch> matches = mutual_matches(source_features, target_.features);
    matches.resize(std::min(matches.size(), options_.most_matches));
    std::vector<Eigen::Vector3d> p, q;
    for (const FeatureMatch& match : matches) {
      p.push_back(source_.target.index.points.offset(match.source).cast<double>());
      q.push_back(target_.target.index.points.offset(match.target).cast<double>());
    }
    std::vector<double> scales{scale};
    if (options_.with_scale) scales = voted_scales(p, q, 10.0 * voxel_m_, 3);
    for (const double s : scales) {
      const auto hypotheses =
          compatible_hypotheses(p, q, s, options_.with_scale, kToleranceVoxels * voxel_m_, kHypotheses);
      for (const Hypothesis& h : hypotheses) {
        candidates.push_back({h.T, overlap_score(source_, target_, h.T, 3.0 * voxel_m_)});
      }
    }
  }

 private:
  FeatureCloud& source_;
  FeatureCloud& target_;
  double voxel_m_;
  const GlobalOptions& options_;
};

/// Scales of the source that features are computed for. Their radius forgives about 15 %.
std::vector<double> scale_guesses(const PointCloud& source, const PointCloud& target, bool with_scale) {
  if (!with_scale) return {1.0};
  const double ratio = size_of(target) / size_of(source);
  return {ratio, ratio * 1.25, ratio / 1.25};
}

void require_points(const PointCloud& cloud, const char* which) {
  if (cloud.size() < 10) {
    throw UnsupportedError(fmt::format("{} points of the {} are too few for global registration", cloud.size(), which));
  }
  if (!(size_of(cloud) > 0.0)) throw UnsupportedError(fmt::format("all points of the {} coincide", which));
}

Similarity best_guess(const PointCloud& source, const PointCloud& target, double voxel_m,
                      const GlobalOptions& options) {
  constexpr double kGood = 0.5;  ///< overlap from which no further scale is tried
  FeatureCloud target_features(target, voxel_m);
  std::vector<Candidate> candidates;
  const auto best = [&] {
    return std::max_element(candidates.begin(), candidates.end(),
                            [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
  };
  for (const double scale : scale_guesses(source, target, options.with_scale)) {
    FeatureCloud source_features(source, voxel_m / scale);
    Matcher matcher(source_features, target_features, voxel_m, options);
    matcher.try_features(source_features.features, scale, candidates);
    for (Fpfh& feature : source_features.features) feature = with_flipped_normals(feature);
    matcher.try_features(source_features.features, scale, candidates);
    if (!candidates.empty() && best()->score > kGood) break;
  }
  if (candidates.empty()) {
    throw UnsupportedError("no matching features: the clouds have nothing in common, or no shape to match");
  }
  return best()->local;
}

}  // namespace

Alignment global_registration(const PointCloud& source, const PointCloud& target, const GlobalOptions& options) {
  require_points(source, "source");
  require_points(target, "target");
  const double voxel_m = options.voxel_m.value_or(size_of(target) / kCoarseVoxelsPerSize);
  const double fine_voxel_m = options.fine_voxel_m.value_or(voxel_m / 8.0);
  if (!(voxel_m > 0.0) || !(fine_voxel_m > 0.0)) throw UsageError("voxel_m must be above 0");
  const Similarity guess = world_transform(best_guess(source, target, voxel_m, options), source.origin, target.origin);

  IcpOptions refinement;
  refinement.metric = IcpMetric::kGicp;
  refinement.with_scale = options.with_scale;
  refinement.levels.clear();
  for (int level = 0; level < kLevels; ++level) {
    const double share = static_cast<double>(level) / (kLevels - 1);
    const double size_m = voxel_m * std::pow(fine_voxel_m / voxel_m, share);
    refinement.levels.push_back({size_m, (level == 0 ? 5.0 : 10.0) * size_m, 50});
  }
  Alignment result = icp(source, target, guess.matrix(), refinement);
  result.method = "global";
  return result;
}

}  // namespace cmap
