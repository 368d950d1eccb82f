#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cmap/io/output_file.hpp"

namespace cmap {

/// A report that an evaluation left in a file, of a pair or of one map.
struct SavedReport {
  std::string path;
  std::string name;  ///< heads its column
  nlohmann::ordered_json json;
};

/// Reads a report of this version or an earlier one; options that an earlier one did not know are filled in.
/// Throws InputError for a file that is missing, not JSON or damaged, naming file, place and reason; UsageError for
/// what is no report, or of a schema that this version does not know.
SavedReport read_report(const std::filesystem::path& path);

/// Throws InputError naming `source` and the member that is missing or of another type than in a report.
void check_report(const nlohmann::ordered_json& report, const std::string& source);

/// Gives each report its name, or the shortest end of its path that tells it from the others. Throws UsageError where
/// names are not one for each report, repeat or are empty, or a file is given twice.
void name_reports(std::vector<SavedReport>& reports, const std::vector<std::string>& names);

struct ComparisonOptions {
  std::vector<std::string> metrics;     ///< groups, ids or symbols; empty: all there are
  std::optional<std::size_t> baseline;  ///< index of the report that the others are measured against
  bool plain_ranking = false;           ///< best and second best by value alone
  bool bands = false;                   ///< in LaTeX, too: the spread over the grid's phases behind a value
};

/// Throws UsageError naming two reports and what differs: parameters, definitions of a metric, or the reference map.
/// Only what bears on the metrics of the options counts. Which metrics were chosen may differ, as it changes no value.
void require_comparable(const std::vector<SavedReport>& reports, const ComparisonOptions& options = {});

/// What a reader must know where comparable reports come from different versions of cmap; empty where from one.
std::vector<std::string> version_notes(const std::vector<SavedReport>& reports, const ComparisonOptions& options);

/// "text", "markdown", "csv", "latex", "html".
enum class ComparisonFormat { kText, kMarkdown, kCsv, kLatex, kHtml };

/// Rows are metrics and skills, columns reports. Best and second best of each row are marked, and share their mark with
/// all that are not distinguishable from them: where the interval of the paired difference (of reports with bootstrap
/// blocks) holds 0, or its sign changes over the grid's phases. What nobody tested has a mark of its own, and a note
/// says how many rankings are distinguishable. With a baseline a second table says by how much each report is better
/// (+) or worse (-) than it, and, where all reports have bootstrap blocks of one size, a third the intervals of these
/// differences. The reports must be comparable. Throws UsageError for an unknown metric, or where none is left.
std::string format_comparison(const std::vector<SavedReport>& reports, const ComparisonOptions& options,
                              ComparisonFormat format);

/// Throws UsageError for a name that is no picture's, UnsupportedError where pictures other than .svg are not built.
void check_figure_name(const std::filesystem::path& name);

/// A chart of bars for each metric, with the spread over the grid's phases or the report's interval, and of curves for
/// each with thresholds, and of local color recall and its chance against tau where a report has them: as SVG, or as a
/// picture of the name's format.
void write_comparison_figure(const std::vector<SavedReport>& reports, const ComparisonOptions& options,
                             const std::filesystem::path& name, OutputFile& file);

}  // namespace cmap
