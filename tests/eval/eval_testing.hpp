#pragma once

// Small maps and helpers for the tests of evaluations and reports.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/eval/evaluation.hpp"
#include "cmap/peers/peer_tool.hpp"
#include "cmap/report/record_json.hpp"
#include "core/refusal.hpp"
#include "spatial/clouds.hpp"

namespace cmap::test {

/// A map of given points and 8-bit colors.
inline PointCloud small_map(const std::vector<Eigen::Vector3f>& positions, const std::vector<Rgb8>& colors = {}) {
  PointCloud map;
  map.positions.assign(positions.begin(), positions.end());
  if (!colors.empty()) map.colors = Array<Rgb8>(colors.begin(), colors.end());
  return map;
}

/// A gray map.
inline PointCloud gray_map(const std::vector<Eigen::Vector3f>& positions) {
  return small_map(positions, std::vector<Rgb8>(positions.size(), Rgb8{128, 128, 128}));
}

/// A painted surface.
inline PointCloud painted_sheet(std::size_t n, unsigned seed) {
  PointCloud map = sheet_cloud(n, seed);
  paint(map, seed + 7);
  return map;
}

inline std::vector<std::string> warning_ids(const std::vector<Warning>& warnings) {
  std::vector<std::string> ids;
  for (const Warning& warning : warnings) ids.push_back(warning.id);
  return ids;
}

/// A metric's record as reports hold it; null where it was not computed.
inline nlohmann::ordered_json fields_of(const MetricRecords& metrics, std::string_view id) {
  const Record* record = metrics.find(id);
  return record == nullptr ? nlohmann::ordered_json() : record_json(*record);
}

/// All records by their metrics.
inline nlohmann::ordered_json fields_of(const MetricRecords& metrics) {
  nlohmann::ordered_json all;
  for (const MetricRecord& metric : metrics) all[metric.info->id] = record_json(metric.record);
  return all;
}

/// What another tool would print; null where the maps have not what it needs.
inline nlohmann::ordered_json peer_fields(const Evaluation& evaluation, std::string_view tool) {
  const auto peer = std::ranges::find(evaluation.peers, tool, &PeerRecord::tool);
  if (peer == evaluation.peers.end()) throw std::out_of_range("no record of that tool");
  return peer->record ? record_json(*peer->record) : nlohmann::ordered_json();
}

/// No warning.
inline const std::vector<std::string> kNone;

inline std::vector<const PeerTool*> tools(const std::vector<std::string>& names) {
  std::vector<const PeerTool*> tools;
  for (const std::string& name : names) tools.push_back(peer_tool(name));
  return tools;
}

inline AlignMethod aligner(std::string_view name) {
  for (const auto& [method, known] : align_method_names()) {
    if (known == name) return method;
  }
  throw std::out_of_range("no such way to align");
}

inline EvaluationOptions options_for(std::vector<std::string> metrics) {
  EvaluationOptions options;
  options.metrics = std::move(metrics);
  return options;
}

inline std::filesystem::path source_path(const char* relative) {
  const char* source = std::getenv("CMAP_SOURCE_DIR");
  if (source == nullptr) throw std::runtime_error("run by CTest, which sets CMAP_SOURCE_DIR");
  return std::filesystem::path(source) / relative;
}

}  // namespace cmap::test
