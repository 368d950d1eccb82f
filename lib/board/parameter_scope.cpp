#include "parameter_scope.hpp"

#include <algorithm>
#include <map>

namespace cmap {
namespace {

using Ids = std::set<std::string>;

const std::map<std::string, Ids>& scopes() {
  static const Ids kWithThresholds{"accuracy", "fitness", "completeness", "f_score"};
  static const Ids kGaussians{"average_wasserstein", "spatial_consistency"};
  static const std::map<std::string, Ids> scopes{
      {"thresholds", kWithThresholds},
      {"overlap-distance", {"overlap", "chamfer", "rmse"}},
      {"lcr-tau", {"local_color_recall"}},
      {"lcr-radius", {"local_color_recall", "delta_e", "color_distance_exposure_free"}},
      {"ccs-voxel", {"color_consistency"}},
      {"ccs-min-points", {"color_consistency"}},
      {"ccs-singletons", {"color_consistency"}},
      {"awd-voxel", kGaussians},
      {"awd-min-points", kGaussians},
      {"scs-radius", {"spatial_consistency"}},
      {"cw-voxel", {"color_wasserstein"}},
      {"cw-min-points", {"color_wasserstein"}},
      {"mme-radius", {"mean_map_entropy"}},
      {"mme-min-neighbors", {"mean_map_entropy"}},
      {"color-max-distance", {"color_distance", "color_fidelity", "color_distance_exposure_free"}}};
  return scopes;
}

}  // namespace

bool bears_on(const std::string& parameter, const Ids& metrics) {
  const auto scope = scopes().find(parameter);
  return scope == scopes().end() ||
         std::ranges::any_of(scope->second, [&](const std::string& id) { return metrics.contains(id); });
}

}  // namespace cmap
