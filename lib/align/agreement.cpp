#include "agreement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cmap {
namespace {

constexpr double kSameFacing = 0.8;          ///< cosine between normals
constexpr double kAlongSpacings = 2.5;  ///< of the points met, along surfaces
constexpr double kLooseSpacings = 1.5;  ///< where there is no surface

bool agrees(const Eigen::Vector3d& d, const Eigen::Vector3d& normal, const Surface& surface, std::uint32_t slot,
            double sq_distance, double reach_m, double spacing_m) {
  const double loose_m = std::max(kLooseSpacings * spacing_m, reach_m);
  if (!(normal.squaredNorm() > 0.5) || !is_surface(surface, slot)) return sq_distance <= loose_m * loose_m;
  const double along_m = std::max(kAlongSpacings * spacing_m, reach_m);
  const Eigen::Vector3d met = surface.normal(slot);
  return sq_distance <= along_m * along_m && std::abs(normal.dot(met)) >= kSameFacing && std::abs(d.dot(met)) <= reach_m &&
         std::abs(d.dot(normal)) <= reach_m;
}

}  // namespace

AgreementField::AgreementField(WitnessMap& source, WitnessMap& target, double reach_m)
    : source_(source), target_(target), reach_m_(reach_m) {}

const WitnessMap::Witness& AgreementField::witness(std::size_t i) const {
  const std::size_t n = source_.witnesses.size();
  return i < n ? source_.witnesses[i] : target_.witnesses[i - n];
}

Agreement AgreementField::at(const Similarity& local, std::size_t step) {
  Agreement found;
  found.state.assign(size(), Agreement::kUnseen);
  look(source_, target_, local, reach_m_, step, 0, found);
  look(target_, source_, local.inverse(), reach_m_ / local.scale, step, source_.witnesses.size(), found);
  return found;
}

void AgreementField::look(WitnessMap& from, WitnessMap& to, const Similarity& local, double reach_m, std::size_t step,
                          std::size_t first, Agreement& found) {
  const PointBlocks& points = from.points.points();
  Array<std::uint32_t> seen;
  for (std::size_t slot = 0; slot < points.size; slot += step) {
    if (to.was_seen_at(MovingSource::moved(local, points, slot))) seen.push_back(static_cast<std::uint32_t>(slot));
  }
  if (seen.empty()) return;
  PointBlocks chosen = chosen_points(points, seen);
  chosen.origin = to.fine.index.points.origin;
  for (std::size_t i = 0; i < chosen.blocks.size() * kBlockSize; ++i) {
    PointBlock& block = chosen.blocks[i / kBlockSize];
    const std::size_t lane = i % kBlockSize;
    const Eigen::Vector3f p =
        (local * Eigen::Vector3f(block.x[lane], block.y[lane], block.z[lane]).cast<double>()).cast<float>();
    block.x[lane] = p.x();
    block.y[lane] = p.y();
    block.z[lane] = p.z();
  }
  const NearestField field = find_nearest(to.fine.index, chosen);
  const double farthest_m = std::max(kAlongSpacings * to.spacing_m, reach_m);
  to.fine.fit_surface(field, farthest_m);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const WitnessMap::Witness& witness = from.witnesses[seen[i]];
    bool is_met = field.sq_dist[i] <= farthest_m * farthest_m;
    if (is_met) {
      const Eigen::Vector3d d =
          (chosen.offset(i) - to.fine.index.points.offset(field.slot[i])).template cast<double>();
      is_met = agrees(d, local.rotation * witness.normal.cast<double>(), to.fine.surface, field.slot[i],
                      field.sq_dist[i], reach_m, to.spacing_m);
    }
    found.state[first + seen[i]] = is_met ? Agreement::kAgrees : Agreement::kDisagrees;
    Agreement::Sums& sums = found.by_class[witness.kind];
    sums.common += static_cast<double>(witness.weight);
    if (is_met) sums.agreeing += static_cast<double>(witness.weight);
  }
}

Chance AgreementField::chance_about(const Similarity& local, double shortest_m) {
  constexpr int kDirections = 6;
  constexpr std::size_t kStep = 4;
  constexpr double kPrior = 4.0, kPriorShare = 0.3;
  std::array<Agreement::Sums, WitnessMap::kClasses> sums{};
  for (auto& of : sums) of = {kPrior, kPrior * kPriorShare};
  for (const double lengths : {1.0, 2.3}) {
    for (int direction = 0; direction < kDirections; ++direction) {
      const double angle = 2.0 * std::numbers::pi * (direction + 0.25 * lengths) / kDirections;
      const Eigen::Vector3d shift = lengths * shortest_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
      Similarity moved = local;
      moved.translation += target_.columns.upright.transpose() * shift;
      const Agreement found = at(moved, kStep);
      for (std::size_t k = 0; k < sums.size(); ++k) {
        sums[k].common += found.by_class[k].common;
        sums[k].agreeing += found.by_class[k].agreeing;
      }
    }
  }
  Chance chance{};
  for (std::size_t k = 0; k < sums.size(); ++k) chance[k] = sums[k].agreeing / sums[k].common;
  return chance;
}

}  // namespace cmap
