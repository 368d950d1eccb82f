#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "verdict/witness.hpp"

namespace cmap {

/// How two maps agree at a pose, both ways.
struct Agreement {
  enum State : std::uint8_t { kUnseen, kDisagrees, kAgrees };
  std::vector<State> state;  ///< of each witness, the source's by slot, then the target's

  struct Sums {
    double common = 0.0, agreeing = 0.0;  ///< weights of the witnesses
  };
  std::array<Sums, WitnessMap::kClasses> by_class{};

  /// Of a witness that was seen: whether it agrees.
  void add(std::size_t i, const WitnessMap::Witness& witness, bool it_agrees);
};

/// Share of the witnesses of a class that agree wherever the maps lie on each other.
using Chance = std::array<double, WitnessMap::kClasses>;

/// From poses most of which are wrong.
Chance chance_among(std::span<const Agreement> agreements);

/// Compares two maps' witnesses with the other's surface: near, and facing the same way.
class AgreementField {
 public:
  /// Both maps must outlive it.
  AgreementField(WitnessMap& source, WitnessMap& target) : source_(source), target_(target) {}

  /// `local`: rigid, from offsets from the source's origin to offsets from the target's; `reach_m`: along normals. Each
  /// step-th witness takes part.
  Agreement at(const Similarity& local, double reach_m, std::size_t step = 1);

  /// From the agreement after shifts across the target's up in all directions, by shortest_m and more: on the ground,
  /// everything agrees with the ground.
  Chance chance_about(const Similarity& local, double reach_m, double shortest_m);

  /// What agreement could be at most: of the same witnesses that were seen there, each compared with its neighbor in
  /// its own map, as if the other map were another sample of it.
  Agreement at_best(const Agreement& found, double reach_m);

  const WitnessMap::Witness& witness(std::size_t i) const {
    return i < source_.size() ? source_[i] : target_[i - source_.size()];
  }
  std::size_t size() const { return source_.size() + target_.size(); }

 private:
  void look_at_home(WitnessMap& map, double reach_m, std::size_t first, Agreement& best);
  void look(WitnessMap& from, WitnessMap& to, const Similarity& local, double reach_m, std::size_t step,
            std::size_t first, Agreement& found);

  WitnessMap& source_;
  WitnessMap& target_;
};

/// What an agreement is worth against chance.
struct Worth {
  /// Of the witnesses, as each class tells right from wrong (one minus its chance): the share that agrees, less what
  /// chance gives, 0 by chance and 1 at most.
  double score = 0.0;
  double support = 0.0;   ///< witnesses that agree beyond chance
  double evidence = 0.0;  ///< log likelihood ratio against chance
};
Worth worth_of(const Agreement& agreement, const Chance& chance);

/// How many standard errors a pose fits better than another, witness by witness.
double advantage(const AgreementField& field, const Agreement& of, const Agreement& over, const Chance& chance);

}  // namespace cmap
