#include <algorithm>
#include <cmath>

#include "cmap/metrics/catalog.hpp"
#include "cmap/metrics/metric_sums.hpp"
#include "cmap/peers/peer_tool.hpp"

namespace cmap {
namespace {

double recalled_share(const MapPair& pair) {
  constexpr double kTau = 0.1, kRadius_m = 0.5;
  const auto classes = find_recall(pair, {.tau = kTau, .radius_m = kRadius_m, .radius_steps = 0.0}).classes;
  return static_cast<double>(std::ranges::count(classes, RecallClass::kRecalled)) / static_cast<double>(classes.size());
}

/// At its defaults, whatever ours are.
Record color_map_evaluation_record(MetricInputs& inputs, const PeerOptions&) {
  constexpr double kVoxel_m = 0.1;
  MetricInputs own(MetricOptions{}, *inputs.pair);
  std::vector<Warning> unused;
  const double cd = *measure(catalog::color_distance, own, unused).value;
  const double cf_db = -20.0 * std::log10(cd);
  const double lcr = recalled_share(*inputs.pair);
  const ColorConsistency ccs = color_consistency(inputs.estimate, kVoxel_m, 2);
  Record record;
  record.add("definition",
             "Color-Map-Evaluation 0.1.0 at its defaults: tau 0.1, radius 0.5 m, voxels of 0.1 m, singletons zero");
  record.add("CD", cd).add("CD_rgb255", 255.0 * cd);
  if (std::isinf(cf_db)) {
    record.add("CF_dB", "+inf");
  } else {
    record.add("CF_dB", cf_db);
  }
  record.add("LCR", lcr).add("LCR_percent", 100.0 * lcr);
  return record.add("CCS", ccs.trace.value() / ccs.n_occupied.value());
}

}  // namespace

namespace peers {

extern constinit const PeerTool color_map_evaluation{
    .name = "color-map-evaluation",
    .record = color_map_evaluation_record,
    .no_color_id = "color_map_evaluation_needs_color",
    .no_color = "Color-Map-Evaluation's numbers need a color at every point of both maps: null"};

}  // namespace peers
}  // namespace cmap
