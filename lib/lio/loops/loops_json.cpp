#include <cmath>
#include <nlohmann/json.hpp>

#include "cmap/io/options_json.hpp"
#include "cmap/io/transform_file.hpp"
#include "cmap/lio/loop_closure.hpp"
#include "loops/loop_fields.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json judgment_json(const Judgment& judgment) {
  Json json{{"verdict", name_of(judgment.verdict, verdict_names())},
            {"reason", judgment.reason},
            {"score", judgment.score},
            {"rivals", Json::array()},
            {"weak", Json::array()}};
  for (const RivalPose& rival : judgment.rivals) {
    json["rivals"].push_back({{"T_from_to", transform_json(rival.T_dst_src)}, {"score", rival.score}});
  }
  for (const WeakDirection& direction : judgment.weak) {
    json["weak"].push_back(
        {{"direction", direction.name}, {"standard_error_m", number_or_null(direction.standard_error_m)}});
  }
  return json;
}

Json candidate_json(const LoopCandidate& c, std::span<const Keyframe> keyframes) {
  const bool is_aligned = std::isfinite(c.error_m);
  const auto if_aligned = [&](double v) { return is_aligned ? number_or_null(v) : Json(nullptr); };
  Json json{{"from", c.from},
            {"to", c.to},
            {"from_time_s", keyframes[c.from].time_s},
            {"to_time_s", keyframes[c.to].time_s},
            {"source", name_of(c.source, loop_source_names())},
            {"round", c.round},
            {"path_m", c.path_m},
            {"pose_distance_m", c.pose_distance_m},
            {"drift_bound_m", c.drift_bound_m},
            {"descriptor_score", c.descriptor_score},
            {"start_yaw_rad", c.yaw_rad}};
  json["accepted"] = c.accepted;
  json["reason"] = c.reason;
  json["alignment"] = judgment_json(c.verdict);
  json["T_from_to"] = is_aligned ? transform_json(c.T_from_to.matrix()) : Json(nullptr);
  json["inlier_share"] = if_aligned(c.inlier_share);
  json["rmse_m"] = if_aligned(c.rmse_m);
  json["standard_error_m"] = if_aligned(c.error_m);
  json["correction_m"] = if_aligned(c.correction_m);
  json["correction_deg"] = if_aligned(c.correction_deg);
  json["graph_residual"] = number_or_null(c.residual);
  return json;
}

}  // namespace

nlohmann::ordered_json loops_json(const LoopClosure& closure, std::span<const Keyframe> keyframes,
                                  const LoopOptions& options) {
  LoopOptions copy = options;
  Json json{{"keyframes", keyframes.size()},
            {"submaps", closure.n_submaps},
            {"loops", closure.n_loops},
            {"graph_cost_before", closure.initial_cost},
            {"graph_cost_after", closure.final_cost},
            {"largest_change_m", closure.largest_change_m},
            {"options", options_json(option_fields(copy))},
            {"candidates", Json::array()}};
  for (const LoopCandidate& candidate : closure.candidates) {
    json["candidates"].push_back(candidate_json(candidate, keyframes));
  }
  return json;
}

}  // namespace cmap
