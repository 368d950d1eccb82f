#include "earlier_reports.hpp"

#include <algorithm>
#include <array>

#include "cmap/report/parameters.hpp"
#include "cmap/report/report.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// The earliest first.
constexpr std::array<std::string_view, 2> kSchemas{"cmap.report/1", kReportSchema};

auto place_of(const Json& schema) { return std::ranges::find(kSchemas, schema.get<std::string_view>()); }

/// Voxels of one point were always left out.
void name_singletons(Json& report) {
  constexpr const char* kLeftOut = "exclude";
  report["parameters"]["ccs-singletons"] = kLeftOut;
  const Json::json_pointer parameters("/metrics/color_consistency/parameters");
  if (report.contains(parameters) && !report[parameters].empty()) report[parameters]["singletons"] = kLeftOut;
}

}  // namespace

bool is_known_schema(const Json& schema) { return schema.is_string() && place_of(schema) != kSchemas.end(); }

void complete_earlier_report(Json& report) {
  if (report.at("schema") == kSchemas.front()) name_singletons(report);
  const Json defaults = to_json(EvaluationOptions{});
  for (const auto& [name, value] : defaults.items()) {
    if (!report["parameters"].contains(name)) report["parameters"][name] = value;
  }
}

const std::vector<DefinitionChange>& definition_changes() {
  constexpr std::string_view kAtThreshold = "a distance within rounding of the threshold did not count as at it";
  static const std::vector<DefinitionChange> changes{
      {kReportSchema, "local_color_recall", true, kAtThreshold},
      {kReportSchema, "accuracy", true, kAtThreshold},
      {kReportSchema, "fitness", true, kAtThreshold},
      {kReportSchema, "completeness", true, kAtThreshold},
      {kReportSchema, "f_score", true, kAtThreshold},
      {kReportSchema, "overlap", true, kAtThreshold},
      {kReportSchema, "mean_map_entropy", false, "points in neighborhoods that are flat to rounding counted"}};
  return changes;
}

bool is_before(const Json& report, const DefinitionChange& change) {
  return place_of(report.at("schema")) < std::ranges::find(kSchemas, change.schema);
}

}  // namespace cmap
