#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "cmap/eval/bootstrap.hpp"
#include "scores.hpp"

namespace cmap {

/// The intervals of differences between maps of one reference, from the sums over blocks in their reports: both maps
/// are computed from the same drawn blocks, so that what is hard for both cancels. What was drawn once is kept. Not for
/// several threads at a time.
class PairedBootstrap {
 public:
  /// Null for a map without a report. The reports must outlive it.
  explicit PairedBootstrap(std::vector<const nlohmann::ordered_json*> reports);

  /// Whether map i was evaluated with --bootstrap.
  bool has_blocks(std::size_t i) const;
  /// Whether it could have been, as maps with a reference can, and was not.
  bool lacks_blocks(std::size_t i) const;

  /// That the intervals hold the difference with; of the first map that has blocks.
  double level() const;

  /// Of map b less map a, for each score. Empty where either has no blocks, they differ in size, or are of an earlier
  /// version.
  const std::vector<Interval>& differences(std::size_t a, std::size_t b);

  /// Of the blocks that hold points of either.
  std::size_t n_blocks(std::size_t a, std::size_t b);

 private:
  struct Blocks {
    BlockSums sums;
    MetricSettings settings;
    BootstrapOptions options;
  };
  const Blocks& blocks_of(std::size_t i);
  std::vector<Interval> drawn(std::size_t a, std::size_t b);

  std::vector<const nlohmann::ordered_json*> reports_;
  std::map<std::size_t, Blocks> blocks_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<Interval>> differences_;
};

/// The interval of that score; null where there is none, or where too few replicates have a value.
const Interval* interval_of(const std::vector<Interval>& intervals, const ScoreKind& kind);

}  // namespace cmap
