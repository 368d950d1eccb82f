#include "cmap/align/tanks_and_temples.hpp"
#include "cmap/peers/peer_tool.hpp"

namespace cmap {
namespace {

Record tanks_and_temples_record(MetricInputs& inputs, const PeerOptions& peer_options) {
  const MapPair& pair = *inputs.pair;
  TanksAndTemplesOptions options;
  options.tau_m = peer_options.tanks_and_temples_tau_m;
  options.crop = peer_options.crop;
  const TanksAndTemplesResult r =
      tanks_and_temples(cloud_of(pair.estimate), cloud_of(pair.reference), Eigen::Matrix4d::Identity(), options);
  Record record;
  record.add("definition", "Tanks and Temples toolbox: three stages of ICP with scale, clouds thinned to tau / 2");
  record.add("tau_m", options.tau_m).add("precision", r.precision).add("recall", r.recall).add("f_score", r.f_score);
  record.add("n_estimate", std::uint64_t{r.n_source}).add("n_reference", std::uint64_t{r.n_target});
  return record.add("scale", r.alignment.scale);
}

}  // namespace

namespace peers {

extern constinit const PeerTool tanksandtemples{.name = "tanksandtemples", .record = tanks_and_temples_record};

}  // namespace peers
}  // namespace cmap
