#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cmap/metrics/color_consistency.hpp"
#include "cmap/metrics/color_gaussians.hpp"
#include "cmap/metrics/exposure_gains.hpp"
#include "cmap/metrics/local_color_recall.hpp"
#include "cmap/metrics/map_pair.hpp"
#include "cmap/metrics/metric_options.hpp"
#include "cmap/metrics/wasserstein.hpp"
#include "cmap/spatial/radius.hpp"

namespace cmap {

/// The maps' points: those of the estimate with their nearest of the reference, and the other way round.
enum class Side : std::uint8_t { kEstimate, kReference };

/// What belongs to either side.
template <class T>
struct BothSides {
  T estimate{}, reference{};
  T& of(Side side) { return side == Side::kEstimate ? estimate : reference; }
  const T& of(Side side) const { return side == Side::kEstimate ? estimate : reference; }
};

/// The thresholds and the overlap distance in ascending order, each once: distances between two of them are a band.
class DistanceBands {
 public:
  explicit DistanceBands(const MetricOptions& options);
  /// The last one lies beyond all of them.
  std::size_t size() const { return upper_m_.size() + 1; }
  std::span<const double> upper_m() const { return upper_m_; }
  /// The bands within a threshold, one of the options', are the first so many.
  std::size_t n_within(double threshold_m) const;

 private:
  std::vector<double> upper_m_;
};

/// The parameters of metrics, and what follows from them alone.
struct MetricSettings {
  explicit MetricSettings(const MetricOptions& metric_options) : options(metric_options), bands(metric_options) {}
  MetricOptions options;
  DistanceBands bands;
};

/// What metrics read: the maps, and whatever is found of single points and voxels before anything is summed. Whoever
/// needs such a field makes it in its `prepare`, unless another metric has.
struct MetricInputs {
  MetricInputs(const MetricOptions& metric_options, const MapPair& maps)
      : settings(metric_options), estimate(maps.estimate), pair(&maps) {}
  MetricInputs(const MetricOptions& metric_options, const IndexedMap& map) : settings(metric_options), estimate(map) {}

  const MetricOptions& options() const { return settings.options; }
  const IndexedMap& map(Side side) const { return side == Side::kEstimate ? estimate : pair->reference; }
  /// The sides that there are.
  std::vector<Side> sides() const {
    return pair == nullptr ? std::vector{Side::kEstimate} : std::vector{Side::kEstimate, Side::kReference};
  }
  NearestPairs pairs(Side side) const {
    return side == Side::kEstimate ? pair->estimate_to_reference() : pair->reference_to_estimate();
  }

  MetricSettings settings;
  const IndexedMap& estimate;
  const MapPair* pair = nullptr;  ///< none where the estimate is a map alone

  std::optional<LocalColorRecall> recall = {};
  std::optional<ExposureGains> gains = {};
  BothSides<Array<double>> delta_e = {};  ///< by slot; NaN where a pair does not count
  BothSides<std::optional<ColorConsistency>> color_consistency = {};
  std::vector<double> consistency_phases = {};  ///< color consistency of the estimate, x slowest
  std::optional<ColorWasserstein> color_wasserstein = {};
  std::optional<VoxelWasserstein> wasserstein = {};
  std::vector<std::vector<double>> variations = {};  ///< local_variations() of `wasserstein`, by phase
  BothSides<std::optional<NeighborhoodShape>> neighborhoods = {};
};

}  // namespace cmap
