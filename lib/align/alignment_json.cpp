#include <nlohmann/json.hpp>

#include "cmap/align/align.hpp"
#include "cmap/io/transform_file.hpp"

namespace cmap {
namespace {

nlohmann::ordered_json directions_json(const std::vector<WeakDirection>& directions) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const WeakDirection& d : directions) {
    json.push_back({{"direction", d.name}, {"standard_error_m", d.standard_error_m}});
  }
  return json;
}

void add_judgment(const Judgment& judgment, nlohmann::ordered_json& json) {
  const bool is_judged = judgment.verdict != Verdict::kNotJudged;
  json["verdict"] = name_of(judgment.verdict, verdict_names());
  json["reason"] = judgment.reason;
  json["help"] = judgment.help;
  json["score"] = is_judged ? nlohmann::ordered_json(judgment.score) : nlohmann::ordered_json(nullptr);
  json["rivals"] = nlohmann::ordered_json::array();
  for (const RivalPose& rival : judgment.rivals) {
    json["rivals"].push_back({{"T_dst_src", transform_json(rival.T_dst_src)}, {"score", rival.score}});
  }
  json["weak"] = directions_json(judgment.weak);
}

}  // namespace

nlohmann::ordered_json alignment_json(const Alignment& a) {
  nlohmann::ordered_json json{{"method", a.method},         {"T_dst_src", transform_json(a.T_dst_src)},
                              {"scale", a.scale},           {"overlap", a.overlap},
                              {"rmse_m", a.rmse_m},         {"n_source", a.n_source},
                              {"n_target", a.n_target},     {"n_matches", a.n_matches},
                              {"condition", a.condition},   {"weakest_direction", a.weakest},
                              {"iterations", a.iterations}, {"converged", a.converged},
                              {"voxel_m", a.voxel_m},       {"max_distance_m", a.max_distance_m},
                              {"warnings", a.warnings}};
  json["standard_errors"] = directions_json(a.standard_errors);
  add_judgment(a.judgment, json);
  return json;
}

}  // namespace cmap
