#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cmap/eval/map_evaluation.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// A map as it was read: what the report says about an input.
struct InputDescription {
  FileInfo file;
  std::string color;  ///< none, u8, u16, f32
  Eigen::Vector3d origin_m;
  Box3d bounds_m;
};
InputDescription describe(const PointCloudFile& file);

/// A command line as one would type it into a shell.
std::string shell_command(const std::vector<std::string>& words);

/// How the evaluation was run: the only part of a report that differs between two equal runs.
struct RunDescription {
  std::string command;
  std::string started_utc;
  double wall_s = 0.0;
  std::vector<std::pair<std::string, double>> stage_seconds;
  int threads = 0;
  std::string simd;
};

/// What reports say of themselves; it changes with the meaning of a member or the definition of a metric.
inline constexpr const char* kReportSchema = "cmap.report/2";

/// The report (REPORT; configs/report.schema.json). Numbers round-trip; missing ones are null.
nlohmann::ordered_json make_report(const InputDescription& reference, const InputDescription& estimate,
                                   const Evaluation& evaluation, const RunDescription& run);

/// The report of one map: no inputs.reference, alignment null.
nlohmann::ordered_json make_report(const InputDescription& map, const MapEvaluation& evaluation,
                                   const RunDescription& run);

/// How wide a table may be, and what stands beside its values.
struct TableLayout {
  bool levels = false;    ///< floor, chance and skill as columns, where the report has them
  std::size_t width = 0;  ///< characters of a line, which remarks beside levels keep to; 0: of any length
};

/// From this width on levels leave room for remarks.
inline constexpr std::size_t kWidthForLevels = 130;

/// A report, of a pair or of one map, as a table for people: groups, symbols, values with their units and directions,
/// warnings below.
std::string format_table(const nlohmann::ordered_json& report, const TableLayout& layout = {});

}  // namespace cmap
