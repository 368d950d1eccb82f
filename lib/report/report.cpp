#include "cmap/report/report.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <Eigen/LU>
#include <cmath>
#include <tuple>

#include "cmap/align/align.hpp"
#include "cmap/core/version.hpp"
#include "cmap/io/transform_file.hpp"
#include "cmap/report/parameters.hpp"
#include "cmap/report/record_json.hpp"
#include "cmap/report/table_text.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json input_json(const InputDescription& input) {
  Json left_out = Json::object();
  for (const LeftOut& points : input.file.left_out) left_out[points.reason] = points.n;
  return {{"path", valid_utf8(input.file.path)},
          {"sha256", input.file.sha256},
          {"format", input.file.format},
          {"points", input.file.points},
          {"finite_points", input.file.finite_points},
          {"left_out", left_out},
          {"color", input.color},
          {"color_scale", input.file.color_scale.empty() ? Json(nullptr) : Json(input.file.color_scale)},
          {"origin_m", vector_json(input.origin_m)},
          {"bounds_m", {{"min", vector_json(input.bounds_m.min)}, {"max", vector_json(input.bounds_m.max)}}}};
}

/// The scores before, as in `metrics` but for what the catalog says anyway.
Json before_json(const Evaluation& evaluation) {
  if (evaluation.metrics_before.empty()) return nullptr;
  Json before = Json::object();
  for (const MetricRecord& metric : evaluation.metrics_before) before[metric.info->id] = record_json(metric.record);
  return before;
}

/// What the search for T_ref_est says of itself; null where there was none.
Json registration_json(const Evaluation& evaluation) {
  if (!evaluation.alignment) return nullptr;
  Json registration = alignment_json(*evaluation.alignment);
  for (const char* said_already : {"method", "T_dst_src", "scale", "warnings"}) registration.erase(said_already);
  return registration;
}

Json alignment_record(const Evaluation& evaluation) {
  const Eigen::Matrix4d& T = evaluation.T_ref_est;
  const bool given = T != Eigen::Matrix4d::Identity();
  const double scale = evaluation.alignment ? evaluation.alignment->scale
                       : given              ? std::cbrt(T.topLeftCorner<3, 3>().determinant())
                                            : 1.0;
  return {{"method", evaluation.alignment ? name_of(evaluation.options.align, align_method_names())
                     : given              ? "given"
                                          : "none"},
          {"T_ref_est", transform_json(T)},
          {"scale", scale},
          {"scale_error", 1.0 / scale - 1.0},
          {"before", before_json(evaluation)},
          {"overlap", evaluation.overlap},
          {"rmse_m", evaluation.rmse_m},
          {"registration", registration_json(evaluation)}};
}

Json metric_json(const MetricRecord& metric) {
  Json json = record_json(metric.record);
  json["unit"] = metric.info->unit;
  json["better"] = metric.info->better.empty() ? Json(nullptr) : Json(metric.info->better);
  json["symbol"] = metric.info->symbol;
  if (!json.contains("parameters")) json["parameters"] = Json::object();
  return json;
}

Json peers_json(const std::vector<PeerRecord>& peers) {
  Json json = Json::object();
  for (const PeerRecord& peer : peers) json[peer.tool] = peer.record ? record_json(*peer.record) : Json(nullptr);
  return json;
}

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

Json run_json(const RunDescription& run) {
  Json stages = Json::object();
  for (const auto& [name, seconds] : run.stage_seconds) stages[name] = seconds;
  return {{"command", valid_utf8(run.command)},
          {"started_utc", run.started_utc},
          {"wall_s", run.wall_s},
          {"stages", stages},
          {"threads", run.threads},
          {"simd", run.simd},
          {"peak_memory_bytes", peak_memory_bytes()}};
}

/// What readers decided on the user's behalf.
void add_input_warnings(Json& warnings, const char* which, const InputDescription& input) {
  const std::uint64_t dropped = input.file.points - input.file.finite_points - input.file.n_left_out();
  if (dropped > 0) {
    warnings.push_back(
        {{"id", "non_finite_points_dropped"},
         {"message", std::string(which) + ": " + std::to_string(dropped) + " of " + std::to_string(input.file.points) +
                         " points are not finite and were dropped"}});
  }
  for (const std::string& note : input.file.notes) {
    warnings.push_back({{"id", "input_note"}, {"message", valid_utf8(std::string(which) + ": " + note)}});
  }
  for (const Warning& warning : input.file.warnings) {
    warnings.push_back({{"id", warning.id}, {"message", valid_utf8(std::string(which) + ": " + warning.message)}});
  }
}

void add_warnings(Json& warnings, const std::vector<Warning>& found) {
  for (const Warning& warning : found) {
    warnings.push_back({{"id", warning.id}, {"message", valid_utf8(warning.message)}});
  }
}

/// A network's or a LiDAR's intensity is easily exported as a color.
void warn_of_gray(Json& warnings, const InputDescription& reference, const InputDescription& estimate) {
  const auto is_colored = [](const InputDescription& map) { return map.color != "none" && !map.file.gray_colors; };
  for (const auto& [gray, other, which] :
       {std::tuple(&estimate, &reference, "estimate"), std::tuple(&reference, &estimate, "reference")}) {
    if (!gray->file.gray_colors || gray->color == "none" || !is_colored(*other)) continue;
    warnings.push_back(
        {{"id", "gray_colors"},
         {"message", fmt::format("every color of the {} is a gray, beside a colored map: is it an intensity, "
                                 "or were its pictures gray?",
                                 which)}});
  }
}

Json report_head() { return {{"schema", kReportSchema}, {"tool", {{"name", "cmap_eval"}, {"version", kVersion}}}}; }

Json metrics_json(const MetricRecords& records) {
  Json metrics = Json::object();
  for (const MetricRecord& metric : records) metrics[metric.info->id] = metric_json(metric);
  return metrics;
}

}  // namespace

InputDescription describe(const PointCloudFile& file) {
  return {file.info, std::string(color_type_name(file.cloud.colors)), file.cloud.origin, bounds(file.cloud)};
}

std::string shell_command(const std::vector<std::string>& words) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%#";
  std::string command;
  for (std::string word : words) {
    if (word.empty() || word.find_first_not_of(kPlain) != word.npos) {
      for (std::size_t at = 0; (at = word.find('\'', at)) != word.npos; at += 4) word.replace(at, 1, "'\\''");
      word = fmt::format("'{}'", word);
    }
    command += fmt::format("{}{}", command.empty() ? "" : " ", word);
  }
  return command;
}

Json make_report(const InputDescription& reference, const InputDescription& estimate, const Evaluation& evaluation,
                 const RunDescription& run) {
  Json report = report_head();
  report["inputs"] = {{"reference", input_json(reference)}, {"estimate", input_json(estimate)}};
  report["parameters"] = to_json(evaluation.options);
  report["alignment"] = alignment_record(evaluation);
  report["metrics"] = metrics_json(evaluation.metrics);
  if (!evaluation.peers.empty()) report["aliases"] = peers_json(evaluation.peers);
  if (evaluation.sensitivity) report["sensitivity"] = sensitivity_json(*evaluation.sensitivity);
  if (evaluation.intervals) report["intervals"] = intervals_json(*evaluation.intervals);
  if (evaluation.unobserved) report["unobserved"] = observed_json(*evaluation.unobserved, evaluation.options);
  report["warnings"] = Json::array();
  add_input_warnings(report["warnings"], "reference", reference);
  add_input_warnings(report["warnings"], "estimate", estimate);
  warn_of_gray(report["warnings"], reference, estimate);
  add_warnings(report["warnings"], evaluation.warnings);
  report["run"] = run_json(run);
  return report;
}

Json make_report(const InputDescription& map, const MapEvaluation& evaluation, const RunDescription& run) {
  Json report = report_head();
  report["inputs"] = {{"estimate", input_json(map)}};
  report["parameters"] = to_json(evaluation.options);
  report["alignment"] = nullptr;
  report["metrics"] = metrics_json(evaluation.metrics);
  report["warnings"] = Json::array();
  add_input_warnings(report["warnings"], "map", map);
  add_warnings(report["warnings"], evaluation.warnings);
  report["run"] = run_json(run);
  return report;
}

}  // namespace cmap
