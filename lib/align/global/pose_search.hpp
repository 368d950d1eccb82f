#pragma once

#include <memory>
#include <vector>

#include "icp/icp_levels.hpp"
#include "verdict/agreement.hpp"

namespace cmap {

/// A pose of the source on the target and how the maps agree there.
struct JudgedPose {
  Similarity local;  ///< from offsets from the source's origin to offsets from the target's
  Agreement agreement;
  Worth worth;
};

/// Two maps of one scale, prepared for poses to be searched and judged.
class PoseSearch {
 public:
  PoseSearch(const PointCloud& source, const PointCloud& target, double voxel_m);

  /// Ways in which the source may stand upright, the most plausible first.
  std::size_t n_stances() const { return source_uprights_.size(); }
  /// Stands the source up: what follows looks along that vertical.
  void stand(std::size_t stance) { stand(source_uprights_[stance]); }
  /// As a pose would have it, which keeps the target's vertical.
  void stand_as(const Similarity& local);
  /// As it most plausibly does, or on its head: so that what reaches out of the map does so to the target's side.
  void stand_like_target();

  /// The best poses by columns, refined, the best first; distinct. `mirrored`: of the source's mirror image.
  std::vector<JudgedPose> search(bool mirrored = false);
  /// Other guesses, refined and judged the same way.
  std::vector<JudgedPose> refined(const std::vector<Similarity>& guesses);
  /// The same pose after finer steps; itself where they find nothing to hold on to.
  Similarity settled(const Similarity& local);
  JudgedPose judge(const Similarity& local, const Chance& chance);
  /// Of agreement at the reach that poses are judged by.
  Chance chance_about(const Similarity& local);
  /// What a pose could be worth at most, where it is.
  Worth best_worth_of(const JudgedPose& pose, const Chance& chance);
  /// Support if every witness agreed.
  double possible_support(const Chance& chance) const;
  double advantage_of(const JudgedPose& pose, const JudgedPose& rival, const Chance& chance) const;

  /// The farthest that two poses place a point of the source apart, m.
  double apart_m(const Similarity& a, const Similarity& b) const;
  /// Poses nearer than this are one.
  double distinct_m() const { return 2.0 * voxel_m_; }
  double voxel_m() const { return voxel_m_; }
  double reach_m() const { return reach_m_; }
  void set_reach_m(double reach_m) { reach_m_ = reach_m; }

 private:
  /// A map standing upright: its columns twice, cut differently, and its witnesses.
  struct Stance {
    Stance(FineMap& fine, const PointCloud& thinned, const Eigen::Matrix3d& upright, double cell_m, double voxel_m);
    ColumnMap columns, recut;
    WitnessMap witnesses;
  };

  /// A level that many poses are refined on.
  struct Refinement {
    IcpOptions options;
    std::unique_ptr<LevelMatches> level = nullptr;
    NextTransform next = nullptr;
  };
  std::vector<Similarity> run(Refinement& refinement, const std::vector<Similarity>& guesses);

  void stand(const Eigen::Matrix3d& upright);
  std::vector<JudgedPose> ranked(std::vector<Similarity> poses, std::size_t n_best);

  Eigen::Vector3d source_origin_;
  double voxel_m_, reach_m_;
  PointCloud thinned_source_, thinned_target_;
  double cell_m_;
  FineMap fine_source_, fine_target_;
  std::vector<Eigen::Matrix3d> source_uprights_;
  std::unique_ptr<Stance> source_stance_, target_stance_;
  std::unique_ptr<AgreementField> field_;
  Refinement coarse_, fine_;
};

/// The voxel to search with: a hundredth of the smaller map's size, a three hundredth of the larger's at least, and so
/// wide that a voxel holds more than one point.
double search_voxel_m(const PointCloud& source, const PointCloud& target);

/// What a box with the same spread would have as its diagonal: blind to a few strays, m.
double size_of(const PointCloud& cloud);

/// The cloud in units that are this many times smaller, world frame.
PointCloud scaled_by(double scale, PointCloud cloud);

}  // namespace cmap
