#include "cmap/peers/cloudcompare.hpp"

#include <cmath>

#include "cmap/peers/peer_tool.hpp"
#include "distances.hpp"

namespace cmap {

CloudCompareDistance cloudcompare_distance(std::span<const double> sq_dist) {
  double sum = 0.0;
  double sum_sq = 0.0;
  for (const double sq : sq_dist) {
    const auto d = static_cast<double>(static_cast<float>(std::sqrt(sq)));
    sum += d;
    sum_sq += d * d;
  }
  const double mean = sum / static_cast<double>(sq_dist.size());
  return {mean, std::sqrt(std::abs(sum_sq / static_cast<double>(sq_dist.size()) - mean * mean))};
}

namespace {

Record cloudcompare_record(MetricInputs& inputs, const PeerOptions&) {
  const CloudCompareDistance d = cloudcompare_distance(peer_distances(inputs, Side::kEstimate));
  Record record;
  record.add("definition", "CloudCompare 2.11 -C2C_DIST, estimate compared with reference");
  return record.add("mean", d.mean_m).add("std", d.standard_deviation_m);
}

}  // namespace

namespace peers {

extern constinit const PeerTool cloudcompare{.name = "cloudcompare", .record = cloudcompare_record};

}  // namespace peers
}  // namespace cmap
