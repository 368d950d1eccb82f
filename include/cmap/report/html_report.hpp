#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cmap/eval/map_evaluation.hpp"
#include "cmap/io/output_file.hpp"

namespace cmap {

/// Writes one HTML file that needs nothing else: the report's metrics with their definitions, histograms of distances
/// and color distances, and both maps in three dimensions, thinned to 300,000 points that are spread evenly over their
/// surfaces. `report` is make_report's of this evaluation; it is in the page as it is, but for absolute paths, of which
/// the page has the file's name alone. The same bytes for any number of threads. The caller commits the file.
void write_html_report(const nlohmann::ordered_json& report, const EvaluatedPair& evaluation, OutputFile& file);

/// The same for one map: no histograms of what needs a second one.
void write_html_report(const nlohmann::ordered_json& report, const EvaluatedMap& evaluation, OutputFile& file);

}  // namespace cmap
