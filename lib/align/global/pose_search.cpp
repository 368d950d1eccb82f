#include "global/pose_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "global/column_search.hpp"
#include "global/upright.hpp"

namespace cmap {
namespace {

// Lengths in voxels.
constexpr double kCell = 1.6;   ///< of the columns
constexpr double kRecut = 0.3;  ///< shift of the second cutting, in cells
constexpr double kBlock = 5.0;  ///< of the witnesses
constexpr double kFineVoxel = 0.25;
constexpr double kCoarseReach = 1.0;  ///< for poses that are not settled, which are this far off
constexpr double kCoarseVoxel = 2.0, kCoarseDistance = 4.0, kFineDistance = 1.5;
constexpr int kRefinedSteps = 15;

constexpr std::size_t kColumnPoses = 32, kRefinedPoses = 8;
constexpr std::size_t kQuickStep = 4;  ///< of the witnesses, for poses from columns

std::span<const Eigen::Vector3f> points_of(const PointCloud& cloud) {
  return {cloud.positions.data(), cloud.positions.size()};
}

/// Of poses most of which are wrong.
std::vector<Worth> worths_among(const std::vector<Agreement>& agreements) {
  const Chance chance = chance_among(agreements);
  std::vector<Worth> worths;
  for (const Agreement& agreement : agreements) worths.push_back(worth_of(agreement, chance));
  return worths;
}

/// So that a voxel holds more than one point.
double wide_enough(const PointCloud& cloud, double voxel_m) {
  constexpr double kKept = 0.7, kWider = 1.4;
  constexpr int kTries = 12;
  for (int i = 0; i < kTries; ++i, voxel_m *= kWider) {
    const auto n_left = static_cast<double>(thinned_to(cloud, voxel_m).size());
    if (n_left < kKept * static_cast<double>(cloud.size())) break;
  }
  return voxel_m;
}

/// Without points that have next to nothing around them. One stray in a hundred points of a dense map is one in ten of
/// the thinned one, and stands as tall as a house.
PointCloud without_strays(const PointCloud& thinned, double voxel_m) {
  constexpr double kCellVoxels = 2.0;
  constexpr int kFewest = 4;  // with its own, in the cells around; a surface has some thirty
  const VoxelFrame frame(bounds(thinned), kCellVoxels * voxel_m);
  std::vector<VoxelKey> key_of;
  VoxelMap<int> counts;
  for (const Eigen::Vector3f& p : thinned.positions) {
    key_of.push_back(frame.key(Eigen::Vector3d(thinned.origin + p.cast<double>())));
    ++counts[key_of.back()];
  }
  const auto n_around = [&](const VoxelKey& key) {
    int n = 0;
    for (int i = 0; i < 27; ++i) {
      const int* count = counts.find({key.x + i / 9 - 1, key.y + i / 3 % 3 - 1, key.z + i % 3 - 1});
      n += count == nullptr ? 0 : *count;
    }
    return n;
  };
  PointCloud kept;
  kept.origin = thinned.origin;
  for (std::size_t i = 0; i < thinned.size(); ++i) {
    if (n_around(key_of[i]) >= kFewest) kept.positions.push_back(thinned.positions[i]);
  }
  return kept.positions.empty() ? thinned : kept;
}

/// Without what lies far out on an axis, where a few points make a map far larger: a scan's last echoes.
PointCloud core_of(const PointCloud& thinned) {
  constexpr std::size_t kTail = 50;  // one in so many, on each side
  constexpr double kFar = 0.75;      // of the whole extent: where the core is smaller, the tails go
  Box3d core = bounds(thinned);
  for (int axis = 0; axis < 3; ++axis) {
    Array<float> values(thinned.size());
    for (std::size_t i = 0; i < thinned.size(); ++i) values[i] = thinned.positions[i][axis];
    const std::size_t tail = values.size() / kTail;
    const double low = thinned.origin[axis] + static_cast<double>(value_at_rank(values, tail));
    const double high = thinned.origin[axis] + static_cast<double>(value_at_rank(values, values.size() - 1 - tail));
    if (high - low > kFar * (core.max[axis] - core.min[axis])) continue;
    core.min[axis] = low;
    core.max[axis] = high;
  }
  return crop(thinned, core);
}

/// The search's cost grows with the cube of the cells that both maps' extents hold: wide maps get wider cells.
double cell_size_m(const PointCloud& source, const PointCloud& target, double voxel_m) {
  constexpr double kCellsOfBoth = 150.0, kMostCellsOfBoth = 300.0, kWidest = 2.0;
  const auto extent_m = [](const PointCloud& cloud) {
    const Box3d box = bounds(cloud);
    return (box.max - box.min).norm();
  };
  const double both_m = extent_m(source) + extent_m(target), usual_m = kCell * voxel_m;
  return std::max({usual_m, std::min(both_m / kCellsOfBoth, kWidest * usual_m), both_m / kMostCellsOfBoth});
}

/// The best by evidence and by support in turn: where scans see different sides of things even a right pose has
/// evidence against it, and a wrong one may find support all over a wide overlap.
std::vector<std::size_t> best_by_either(const std::vector<Worth>& worths, std::size_t n_best) {
  std::vector<std::size_t> by_evidence(worths.size());
  std::iota(by_evidence.begin(), by_evidence.end(), std::size_t{0});
  std::vector<std::size_t> by_support = by_evidence;
  std::stable_sort(by_evidence.begin(), by_evidence.end(),
                   [&](std::size_t a, std::size_t b) { return worths[a].evidence > worths[b].evidence; });
  std::stable_sort(by_support.begin(), by_support.end(),
                   [&](std::size_t a, std::size_t b) { return worths[a].support > worths[b].support; });
  std::vector<std::size_t> best;
  for (std::size_t rank = 0; rank < worths.size(); ++rank) {
    for (const std::size_t i : {by_evidence[rank], by_support[rank]}) {
      if (best.size() < n_best && std::find(best.begin(), best.end(), i) == best.end()) best.push_back(i);
    }
  }
  return best;
}

IcpOptions refinement_options(double voxel_m, double max_distance_m) {
  IcpOptions options;
  options.metric = IcpMetric::kGicp;
  options.levels = {{voxel_m, max_distance_m, kRefinedSteps}};
  options.min_translation_voxels = 5e-3;  // finer levels follow
  options.min_rotation_rad = 1e-4;
  return options;
}

}  // namespace

PoseSearch::Stance::Stance(FineMap& fine, const PointCloud& thinned, const Eigen::Matrix3d& upright, double cell_m,
                           double voxel_m)
    : columns(points_of(thinned), upright, cell_m, voxel_m),
      recut(points_of(thinned), upright, cell_m, voxel_m, kRecut),
      witnesses(fine, columns, kBlock * voxel_m) {}

PoseSearch::PoseSearch(const PointCloud& source, const PointCloud& target, double voxel_m)
    : source_origin_(source.origin),
      voxel_m_(voxel_m),
      reach_m_(kFineVoxel * voxel_m),
      thinned_source_(core_of(without_strays(thinned_to(source, voxel_m), voxel_m))),
      thinned_target_(core_of(without_strays(thinned_to(target, voxel_m), voxel_m))),
      cell_m_(cell_size_m(thinned_source_, thinned_target_, voxel_m)),
      fine_source_(source, kFineVoxel * voxel_m),
      fine_target_(target, kFineVoxel * voxel_m),
      coarse_{refinement_options(kCoarseVoxel * voxel_m, kCoarseDistance * voxel_m)},
      fine_{refinement_options(voxel_m, kFineDistance * voxel_m)} {
  const Ups source_ups = ups_of(thinned_source_), target_ups = ups_of(thinned_target_);
  for (const Eigen::Vector3d& up : source_ups.all) source_uprights_.push_back(upright_from(up));
  target_stance_ =
      std::make_unique<Stance>(fine_target_, thinned_target_, upright_from(target_ups.all.front()), cell_m_, voxel_m_);
  stand(std::size_t{0});
}

void PoseSearch::stand(const Eigen::Matrix3d& upright) {
  field_.reset();
  source_stance_ = std::make_unique<Stance>(fine_source_, thinned_source_, upright, cell_m_, voxel_m_);
  field_ = std::make_unique<AgreementField>(source_stance_->witnesses, target_stance_->witnesses);
}

void PoseSearch::stand_as(const Similarity& local) { stand(target_stance_->columns.upright * local.rotation); }

void PoseSearch::stand_like_target() {
  const auto side = [](const PointCloud& thinned, const Eigen::Matrix3d& upright) {
    const Eigen::Vector3d up = upright.row(2);
    return up.dot(with_longer_tail(thinned, up)) > 0.0;
  };
  const Eigen::Matrix3d& upright = source_uprights_.front();
  const bool is_like = side(thinned_source_, upright) == side(thinned_target_, target_stance_->columns.upright);
  stand(is_like ? upright : Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal() * upright);
}

std::vector<JudgedPose> PoseSearch::search(bool mirrored) {
  const RecutColumns both[] = {{source_stance_->columns, source_stance_->recut},
                               {target_stance_->columns, target_stance_->recut}};
  std::vector<Similarity> poses;
  for (const ColumnPose& pose :
       search_columns(source_stance_->columns, target_stance_->columns, word_scores(both), mirrored, kColumnPoses)) {
    poses.push_back(pose.local);
  }
  return ranked(poses, kRefinedPoses);
}

std::vector<JudgedPose> PoseSearch::ranked(std::vector<Similarity> poses, std::size_t n_best) {
  std::vector<Agreement> agreements;
  for (const Similarity& pose : poses) agreements.push_back(field_->at(pose, kCoarseReach * voxel_m_, kQuickStep));
  const std::vector<Worth> worths = worths_among(agreements);
  std::vector<Similarity> best;
  for (const std::size_t i : best_by_either(worths, n_best)) best.push_back(poses[i]);
  return refined(best);
}

std::vector<Similarity> PoseSearch::run(Refinement& refinement, const std::vector<Similarity>& guesses) {
  if (!refinement.level) {
    refinement.level = std::make_unique<LevelMatches>(thinned_source_, thinned_target_, 1.0,
                                                      refinement.options.levels[0], refinement.options.neighbors);
    refinement.next = icp_metric(refinement.options)(*refinement.level);
  }
  std::vector<Similarity> found;
  for (const Similarity& guess : guesses) {
    try {
      found.push_back(run_level(*refinement.level, refinement.next, guess, refinement.options).local);
    } catch (const UnsupportedError&) {
      // Nothing to hold on to: no pose.
    }
  }
  return found;
}

Similarity PoseSearch::settled(const Similarity& local) {
  const std::vector<Similarity> found = run(fine_, {local});
  return found.empty() ? local : found.front();
}

std::vector<JudgedPose> PoseSearch::refined(const std::vector<Similarity>& guesses) {
  const std::vector<Similarity> found = run(coarse_, guesses);
  std::vector<Agreement> agreements;
  for (const Similarity& pose : found) agreements.push_back(field_->at(pose, kCoarseReach * voxel_m_));
  const std::vector<Worth> worths = worths_among(agreements);
  std::vector<JudgedPose> judged;
  for (const std::size_t i : best_by_either(worths, found.size())) {
    judged.push_back({found[i], agreements[i], worths[i]});
  }
  std::vector<JudgedPose> distinct;
  for (const JudgedPose& pose : judged) {
    const auto is_apart = [&](const JudgedPose& o) { return apart_m(pose.local, o.local) > distinct_m(); };
    if (std::all_of(distinct.begin(), distinct.end(), is_apart)) distinct.push_back(pose);
  }
  return distinct;
}

JudgedPose PoseSearch::judge(const Similarity& local, const Chance& chance) {
  JudgedPose pose{local, field_->at(local, reach_m_), {}};
  pose.worth = worth_of(pose.agreement, chance);
  return pose;
}

Chance PoseSearch::chance_about(const Similarity& local) {
  return field_->chance_about(local, reach_m_, std::max(3.0 * voxel_m_, 6.0 * reach_m_));
}

Worth PoseSearch::best_worth_of(const JudgedPose& pose, const Chance& chance) {
  return worth_of(field_->at_best(pose.agreement, reach_m_), chance);
}

double PoseSearch::possible_support(const Chance& chance) const {
  double sum = 1e-9;
  for (std::size_t i = 0; i < field_->size(); ++i) {
    const WitnessMap::Witness& witness = field_->witness(i);
    sum += static_cast<double>(witness.weight) * (1.0 - chance[witness.kind]);
  }
  return sum;
}

double PoseSearch::advantage_of(const JudgedPose& pose, const JudgedPose& rival, const Chance& chance) const {
  return advantage(*field_, pose.agreement, rival.agreement, chance);
}

double PoseSearch::apart_m(const Similarity& a, const Similarity& b) const {
  const Box3d box = bounds(thinned_source_);
  return farthest_apart(a, b, corners({box.min - source_origin_, box.max - source_origin_}));
}

double size_of(const PointCloud& cloud) {
  const PairMoments spread = pair_moments(cloud.size(), [&](std::size_t i) {
    const Eigen::Vector3d p = cloud.positions[i].cast<double>();
    return WeightedPair{p, p, 1.0};
  });
  return std::sqrt(12.0 * spread.scatter_p.trace() / spread.weight);
}

double search_voxel_m(const PointCloud& source, const PointCloud& target) {
  constexpr double kVoxelsPerSize = 100.0, kMostVoxelsPerSize = 300.0;
  const double a = size_of(source), b = size_of(target);
  const double voxel_m = std::max(std::min(a, b) / kVoxelsPerSize, std::max(a, b) / kMostVoxelsPerSize);
  return std::max(wide_enough(source, voxel_m), wide_enough(target, voxel_m));
}

PointCloud scaled_by(double scale, PointCloud cloud) {
  cloud.origin *= scale;
  for (Eigen::Vector3f& p : cloud.positions) p *= static_cast<float>(scale);
  return cloud;
}

}  // namespace cmap
