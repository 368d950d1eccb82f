#include "cmap/metrics/geometry.hpp"
#include "eval/json_number.hpp"
#include "eval/metric_records.hpp"
#include "eval/record_list.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// One entry for each threshold of the options, from fields_of(index).
template <class FieldsOf>
Json per_threshold(const Findings& findings, FieldsOf&& fields_of) {
  Json list = Json::array();
  for (std::size_t t = 0; t < findings.options.thresholds_m.size(); ++t) {
    Json entry{{"threshold_m", findings.options.thresholds_m[t]}};
    entry.update(fields_of(t));
    list.push_back(entry);
  }
  return Json{{"per_threshold", list}};
}

Json chamfer_fields(const Findings& f) {
  const Chamfer c = chamfer(f.estimate_to_reference, f.reference_to_estimate);
  return {{"value", c.l1_sum},
          {"parameters", {{"overlap_distance_m", f.options.overlap_distance_m}}},
          {"variants",
           {{"l1_sum", c.l1_sum},
            {"l1_mean", c.l1_mean},
            {"l2sq_sum", c.l2sq_sum},
            {"l2_rms_mean", c.l2_rms_mean},
            {"truncated_l1_sum", c.truncated_l1_sum}}},
          {"estimate_to_reference", f.estimate_to_reference.mean_m},
          {"reference_to_estimate", f.reference_to_estimate.mean_m},
          {"n_estimate", f.estimate_to_reference.n},
          {"n_reference", f.reference_to_estimate.n}};
}

Json accuracy_fields(const Findings& f) {
  return per_threshold(f, [&](std::size_t t) -> Json {
    const WithinThreshold& within = f.estimate_to_reference.within[t];
    return {{"value", json_number(within.rmse_m)},
            {"mean", json_number(within.mean_m)},
            {"median", json_number(within.median_m)},
            {"n", within.n}};
  });
}

Json share_fields(const Findings& f, const DistanceStats& direction) {
  Json fields = per_threshold(f, [&](std::size_t t) -> Json {
    return {{"value", direction.share_within(t)}, {"n", direction.within[t].n}};
  });
  fields["n_points"] = direction.n;
  return fields;
}

Json f_score_fields(const Findings& f) {
  return per_threshold(f, [&](std::size_t t) -> Json {
    const double precision = f.estimate_to_reference.share_within(t);
    const double recall = f.reference_to_estimate.share_within(t);
    return {{"value", f_score(precision, recall)}, {"precision", precision}, {"recall", recall}};
  });
}

Json overlap_fields(const Findings& f) {
  const WithinThreshold& within = f.estimate_to_reference.within.back();
  return {{"value", f.estimate_to_reference.share_within(f.options.thresholds_m.size())},
          {"parameters", {{"overlap_distance_m", within.threshold_m}}},
          {"n", within.n},
          {"n_estimate", f.estimate_to_reference.n}};
}

Json hausdorff_fields(const Findings& f) {
  const auto directed = [](const DistanceStats& d) -> Json {
    return {{"max", d.max_m}, {"p95", d.p95_m}, {"p99", d.p99_m}};
  };
  return {{"value", std::max(f.estimate_to_reference.max_m, f.reference_to_estimate.max_m)},
          {"estimate_to_reference", directed(f.estimate_to_reference)},
          {"reference_to_estimate", directed(f.reference_to_estimate)}};
}

Json rmse_fields(const Findings& f) {
  const WithinThreshold& inliers = f.estimate_to_reference.within.back();
  return {{"value", std::sqrt(f.estimate_to_reference.mean_sq_m2)},
          {"inlier_rmse", json_number(inliers.rmse_m)},
          {"parameters", {{"overlap_distance_m", inliers.threshold_m}}},
          {"n", f.estimate_to_reference.n},
          {"n_inliers", inliers.n}};
}

}  // namespace

std::vector<MetricRecord> geometry_records(const Findings& f) {
  RecordList records(f.selection);
  records.add("chamfer", [&] { return chamfer_fields(f); });
  records.add("accuracy", [&] { return accuracy_fields(f); });
  records.add("fitness", [&] { return share_fields(f, f.estimate_to_reference); });
  records.add("completeness", [&] { return share_fields(f, f.reference_to_estimate); });
  records.add("f_score", [&] { return f_score_fields(f); });
  records.add("overlap", [&] { return overlap_fields(f); });
  records.add("hausdorff", [&] { return hausdorff_fields(f); });
  records.add("rmse", [&] { return rmse_fields(f); });
  return records.take();
}

}  // namespace cmap
