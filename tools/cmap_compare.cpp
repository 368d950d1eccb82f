// cmap_compare A.json B.json ...: saved reports side by side.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cmap/board/comparison.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/output_file.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "program.hpp"

namespace {

using cmap::ComparisonFormat;
using cmap::ExitCode;

constexpr const char* kDescription =
    "Puts saved reports of cmap_eval side by side: one row for each metric and its skill, one column for each report.\n"
    "Best and second best are marked, and share their mark with what is not distinguishable from them: the 95 %\n"
    "interval of the paired difference (reports made with --bootstrap) holds 0, or its sign changes over the grid's\n"
    "phases. What neither tests is marked as not tested. Refuses reports whose numbers do not compare: other\n"
    "parameters, definitions or reference map, as far as they bear on --metrics; says where reports come from\n"
    "different versions of cmap.";

constexpr const char* kExample =
    "Examples:\n"
    "  cmap_eval data_samples/town/reference.ply data_samples/town/estimate.ply --bootstrap 1000 --quiet -o a.json\n"
    "  cmap_eval data_samples/town/reference.ply data_samples/town/reference.ply --bootstrap 1000 --quiet -o b.json\n"
    "  cmap_compare a.json b.json --baseline a.json\n"
    "  cmap_compare a.json b.json --figure chart.svg --format html -o comparison.html\n"
    "  cmap_compare a.json b.json --names Ours,Truth --metrics color,AC --format latex -o table.tex\n"
    "\n"
    "Formats: text (* best, + second best, ? best by value alone, not tested), markdown, csv (all digits, empty where\n"
    "there is no value), latex (booktabs, graphicx, xcolor; shrunk to the column where it is wider), html (one file,\n"
    "sortable, offline).\n"
    "Exit codes: 0 done; 2 wrong usage, no reports, or reports that do not compare; 3 a report is missing or damaged;\n"
    "4 this build has no pictures but .svg; 70 internal error.";

struct Arguments {
  std::vector<std::string> reports;
  ComparisonFormat format = ComparisonFormat::kText;
  std::string baseline, output, figure;
  std::vector<std::string> metrics, names;
  bool plain_ranking = false, bands = false;
};

const cmap::EnumNames<ComparisonFormat> kFormats{{ComparisonFormat::kText, "text"},
                                                 {ComparisonFormat::kMarkdown, "markdown"},
                                                 {ComparisonFormat::kCsv, "csv"},
                                                 {ComparisonFormat::kLatex, "latex"},
                                                 {ComparisonFormat::kHtml, "html"}};

void add_options(cmap::CommandLine& line, Arguments& a) {
  line.add("REPORT", a.reports, "A.json B.json ...", "reports of cmap_eval").required();
  line.add_choice("--format", a.format, kFormats, "FORMAT", "text, markdown, csv, latex or html [text]");
  line.add("--metrics", a.metrics, "LIST", "groups, metric ids or symbols [all in the reports]")
      .with_commas()
      .one_at_a_time()
      .not_empty();
  line.add("--baseline", a.baseline, "A.json",
           "also say by how much the others are better (+) or worse (-) than this report")
      .not_empty();
  line.add("--names", a.names, "A,B,...", "headings of the columns [file names]")
      .with_commas()
      .one_at_a_time()
      .not_empty();
  line.add_flag("--plain-ranking", a.plain_ranking,
                "mark best and second best by value alone, whatever noise does to them");
  line.add_flag("--bands", a.bands,
                "in LaTeX, too, write the spread over the grid's phases behind a value: 0.298 ± 0.097");
  line.add("-o,--output", a.output, "FILE", "write here in place of standard output").not_empty();
  line.add("--figure", a.figure, "FILE", "chart of every metric, and curves: .svg, .png, .jpg, .tif").not_empty();
}

/// Index of the baseline among the reports, which it joins as the first unless it is one of them.
std::size_t place_baseline(const std::string& baseline, std::vector<std::string>& reports) {
  std::error_code missing;
  const auto found = std::ranges::find_if(
      reports, [&](const std::string& report) { return std::filesystem::equivalent(report, baseline, missing); });
  if (found != reports.end()) return static_cast<std::size_t>(found - reports.begin());
  reports.insert(reports.begin(), baseline);
  return 0;
}

ExitCode run(Arguments arguments) {
  cmap::ComparisonOptions options{arguments.metrics, std::nullopt, arguments.plain_ranking, arguments.bands};
  if (!arguments.baseline.empty()) options.baseline = place_baseline(arguments.baseline, arguments.reports);
  cmap::refuse_overwriting(arguments.reports, {arguments.output, arguments.figure});
  for (const std::string& output : {arguments.output, arguments.figure}) cmap::require_writable(output);
  if (!arguments.figure.empty()) cmap::check_figure_name(arguments.figure);
  std::vector<cmap::SavedReport> reports;
  for (const std::string& path : arguments.reports) reports.push_back(cmap::read_report(path));
  cmap::name_reports(reports, arguments.names);
  cmap::require_comparable(reports, options);
  for (const std::string& note : cmap::version_notes(reports, options)) {
    fmt::print(stderr, "cmap_compare: warning: {}\n", note);
  }
  const std::string text = cmap::format_comparison(reports, options, arguments.format);
  cmap::OutputFiles files;
  files.add(arguments.figure,
            [&](cmap::OutputFile& file) { cmap::write_comparison_figure(reports, options, arguments.figure, file); });
  files.add(arguments.output, [&](cmap::OutputFile& file) { file.write(text); });
  if (arguments.output.empty() && !cmap::is_standard_output(arguments.figure)) cmap::print(text);
  files.commit();
  return ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  cmap::CommandLine line("cmap_compare", kDescription, std::string(kExample) + cmap::kDash);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(arguments); });
}
