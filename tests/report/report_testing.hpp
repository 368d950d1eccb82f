#pragma once

// Reports for the tests, of small maps.

#include "cmap/report/report.hpp"
#include "eval/eval_testing.hpp"

namespace cmap::test {

inline InputDescription described(const std::string& path, const PointCloud& map) {
  FileInfo info;
  info.path = path;
  info.format = "PLY ascii";
  info.points = info.finite_points = map.size();
  info.sha256 = std::string(64, 'a');
  return describe({map, info});
}

inline RunDescription a_run() {
  return {"cmap_eval ref.ply est.ply", "2024-05-06T07:08:09Z", 1.5, {{"read", 0.5}, {"index", 1.0}}, 2, "avx2"};
}

/// The report of this pair.
inline nlohmann::ordered_json report_of(const PointCloud& reference, const PointCloud& estimate,
                                        const EvaluationOptions& options = {},
                                        const Eigen::Matrix4d& T_ref_est = Eigen::Matrix4d::Identity()) {
  return make_report(described("ref.ply", reference), described("est.ply", estimate),
                     evaluate(reference, estimate, options, T_ref_est), a_run());
}

/// The report of this map alone.
inline nlohmann::ordered_json map_report_of(const PointCloud& map, const EvaluationOptions& options = {}) {
  return make_report(described("map.ply", map), evaluate_map(map, options), a_run());
}

/// The report without what its numbers are worth, as a version before wrote it.
inline nlohmann::ordered_json without_levels(nlohmann::ordered_json report) {
  const auto strip = [](nlohmann::ordered_json& record) {
    for (const char* level : {"floor", "chance", "skill", "skill_map", "phases"}) record.erase(level);
  };
  for (auto& [id, record] : report["metrics"].items()) {
    strip(record);
    if (!record.contains("per_threshold")) continue;
    for (auto& entry : record["per_threshold"]) strip(entry);
  }
  return report;
}

}  // namespace cmap::test
