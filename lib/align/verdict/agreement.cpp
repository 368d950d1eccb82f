#include "verdict/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cmap/spatial/k_nearest.hpp"

namespace cmap {
namespace {

constexpr double kSameFacing = 0.8;     ///< cosine between normals
constexpr double kAlongSpacings = 2.5;  ///< of the points met, along surfaces
constexpr double kLooseSpacings = 1.5;  ///< where there is no surface
constexpr double kMet = 0.8;            ///< share of the witnesses that agree where a pose is right, about

double farthest_m(const FineMap& map, double reach_m) { return std::max(kAlongSpacings * map.spacing_m, reach_m); }

/// `d`: from the point met, `normal`: the witness's, both in the frame of the map met.
bool agrees(const Eigen::Vector3d& d, const Eigen::Vector3d& normal, const FineMap& met, std::uint32_t slot,
            double reach_m) {
  if (!(normal.squaredNorm() > 0.5) || !met.is_surface(slot)) {
    return d.norm() <= std::max(kLooseSpacings * met.spacing_m, reach_m);
  }
  const Eigen::Vector3d other = met.points.surface.normal(slot);
  return std::abs(normal.dot(other)) >= kSameFacing && std::abs(d.dot(other)) <= reach_m &&
         std::abs(d.dot(normal)) <= reach_m;
}

/// What a witness says for a pose, log likelihood ratio; what agrees anyhow says nothing much.
double told(bool it_agrees, double chance) {
  const double p = std::min(chance, 0.9 * kMet);
  return it_agrees ? std::log(kMet / p) : std::log((1.0 - kMet) / (1.0 - p));
}

PointBlocks moved_to(const PointBlocks& points, const Array<std::uint32_t>& slots, const Similarity& local,
                     const Eigen::Vector3d& origin) {
  PointBlocks moved = chosen_points(points, slots);
  moved.origin = origin;
  for (PointBlock& block : moved.blocks) {
    for (std::size_t lane = 0; lane < kBlockSize; ++lane) {
      const Eigen::Vector3d p = local * Eigen::Vector3d(block.x[lane], block.y[lane], block.z[lane]);
      block.x[lane] = static_cast<float>(p.x());
      block.y[lane] = static_cast<float>(p.y());
      block.z[lane] = static_cast<float>(p.z());
    }
  }
  return moved;
}

}  // namespace

void Agreement::add(std::size_t i, const WitnessMap::Witness& witness, bool it_agrees) {
  state[i] = it_agrees ? kAgrees : kDisagrees;
  Sums& sums = by_class[witness.kind];
  sums.common += static_cast<double>(witness.weight);
  if (it_agrees) sums.agreeing += static_cast<double>(witness.weight);
}

Chance chance_among(std::span<const Agreement> agreements) {
  constexpr double kPrior = 4.0, kPriorShare = 0.3;
  Chance chance{};
  for (std::size_t k = 0; k < chance.size(); ++k) {
    double common = kPrior, agreeing = kPrior * kPriorShare;
    for (const Agreement& agreement : agreements) {
      common += agreement.by_class[k].common;
      agreeing += agreement.by_class[k].agreeing;
    }
    chance[k] = std::clamp(agreeing / common, 0.02, 0.98);
  }
  return chance;
}

Agreement AgreementField::at(const Similarity& local, double reach_m, std::size_t step) {
  Agreement found;
  found.state.assign(size(), Agreement::kUnseen);
  look(source_, target_, local, reach_m, step, 0, found);
  look(target_, source_, local.inverse(), reach_m, step, source_.size(), found);
  return found;
}

void AgreementField::look(WitnessMap& from, WitnessMap& to, const Similarity& local, double reach_m, std::size_t step,
                          std::size_t first, Agreement& found) {
  Array<std::uint32_t> seen;
  for (std::size_t slot = 0; slot < from.size(); slot += step) {
    const Eigen::Vector3d p = MovingSource::moved(local, from.points(), slot);
    if (to.was_seen_at(p)) seen.push_back(static_cast<std::uint32_t>(slot));
  }
  if (seen.empty()) return;
  const Bvh& index = to.fine().points.index;
  const PointBlocks moved = moved_to(from.points(), seen, local, index.points.origin);
  const NearestField field = find_nearest(index, moved);
  const double farthest = farthest_m(to.fine(), reach_m);
  to.fine().points.fit_surface(field, farthest);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const WitnessMap::Witness& witness = from[seen[i]];
    bool is_met = field.sq_dist[i] <= farthest * farthest;
    if (is_met) {
      const Eigen::Vector3d d = (moved.offset(i) - index.points.offset(field.slot[i])).cast<double>();
      is_met = agrees(d, local.rotation * witness.normal.cast<double>(), to.fine(), field.slot[i], reach_m);
    }
    found.add(first + seen[i], witness, is_met);
  }
}

Agreement AgreementField::at_best(const Agreement& found, double reach_m) {
  Agreement best;
  best.state = found.state;
  look_at_home(source_, reach_m, 0, best);
  look_at_home(target_, reach_m, source_.size(), best);
  return best;
}

void AgreementField::look_at_home(WitnessMap& map, double reach_m, std::size_t first, Agreement& best) {
  const Bvh& index = map.fine().points.index;
  const Array<std::uint32_t> nearest = find_k_nearest(index, map.points(), 2);
  Array<std::uint32_t> met;
  for (std::size_t slot = 0; slot < map.size(); ++slot) {
    if (nearest[2 * slot + 1] != kNoNeighbor) met.push_back(nearest[2 * slot + 1]);
  }
  map.fine().points.surface.fit(met);
  for (std::size_t slot = 0; slot < map.size(); ++slot) {
    if (best.state[first + slot] == Agreement::kUnseen) continue;
    const WitnessMap::Witness& witness = map[slot];
    const std::uint32_t other = nearest[2 * slot + 1];
    bool is_met = other != kNoNeighbor;
    if (is_met) {
      const Eigen::Vector3d d = (map.points().offset(slot) - index.points.offset(other)).cast<double>();
      is_met = d.norm() <= farthest_m(map.fine(), reach_m) &&
               agrees(d, witness.normal.cast<double>(), map.fine(), other, reach_m);
    }
    best.add(first + slot, witness, is_met);
  }
}

Chance AgreementField::chance_about(const Similarity& local, double reach_m, double shortest_m) {
  constexpr int kDirections = 6;
  constexpr std::size_t kStep = 4;
  std::vector<Agreement> found;
  for (const double lengths : {1.0, 2.3}) {
    for (int direction = 0; direction < kDirections; ++direction) {
      const double angle = 2.0 * std::numbers::pi * (direction + 0.25 * lengths) / kDirections;
      const Eigen::Vector3d shift = lengths * shortest_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
      Similarity moved = local;
      moved.translation += target_.plan().upright.transpose() * shift;
      found.push_back(at(moved, reach_m, kStep));
    }
  }
  return chance_among(found);
}

Worth worth_of(const Agreement& agreement, const Chance& chance) {
  Worth worth;
  double beyond = 0.0, possible = 0.0;
  for (std::size_t k = 0; k < chance.size(); ++k) {
    const auto [common, agreeing] = agreement.by_class[k];
    if (!(common > 0.0)) continue;
    const double p = chance[k];
    beyond += agreeing - p * common;
    possible += (1.0 - p) * common;
    worth.evidence += agreeing * told(true, p) + (common - agreeing) * told(false, p);
  }
  worth.score = possible > 0.0 ? std::max(0.0, beyond / possible) : 0.0;
  worth.support = std::max(0.0, beyond);
  return worth;
}

double advantage(const AgreementField& field, const Agreement& of, const Agreement& over, const Chance& chance) {
  const auto said = [](Agreement::State state, double p) {
    return state == Agreement::kUnseen ? 0.0 : told(state == Agreement::kAgrees, p);
  };
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    const WitnessMap::Witness& witness = field.witness(i);
    const double p = chance[witness.kind];
    const double difference = said(of.state[i], p) - said(over.state[i], p);
    const auto weight = static_cast<double>(witness.weight);
    sum += weight * difference;
    squares += weight * difference * difference;  // a block's witnesses say one thing
  }
  return squares > 0.0 ? sum / std::sqrt(squares) : 0.0;
}

}  // namespace cmap
