#pragma once

#include <array>
#include <vector>

#include "witness.hpp"

namespace cmap {

/// How two maps agree at a pose, both ways.
struct Agreement {
  /// Of each witness, the source's by slot and then the target's: it agrees, does not, or was not to be seen.
  enum State : std::uint8_t { kUnseen, kDisagrees, kAgrees };
  std::vector<State> state;

  struct Sums {
    double common = 0.0, agreeing = 0.0;  ///< weights of the witnesses
  };
  std::array<Sums, WitnessMap::kClasses> by_class{};
};

/// Share of the witnesses of a class that agree wherever the maps lie on each other.
using Chance = std::array<double, WitnessMap::kClasses>;

/// Compares two maps' witnesses with the other's surface: near, and facing the same way.
class AgreementField {
 public:
  /// `reach_m`: along normals; target's units. Both maps must outlive it.
  AgreementField(WitnessMap& source, WitnessMap& target, double reach_m);

  /// `local`: from offsets from the source's origin to offsets from the target's. Each step-th witness.
  Agreement at(const Similarity& local, std::size_t step = 1);

  /// From the agreement after shifts across the target's up by several lengths in all directions: on the ground,
  /// everything agrees with the ground.
  Chance chance_about(const Similarity& local, double shortest_m);

  const WitnessMap::Witness& witness(std::size_t i) const;
  std::size_t size() const { return source_.witnesses.size() + target_.witnesses.size(); }

 private:
  void look(WitnessMap& from, WitnessMap& to, const Similarity& local, double reach_m, std::size_t step,
            std::size_t first, Agreement& found);

  WitnessMap& source_;
  WitnessMap& target_;
  double reach_m_;
};

}  // namespace cmap
