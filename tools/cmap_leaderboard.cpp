// cmap_leaderboard MANIFEST: methods x sequences, every table and picture.

#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "cmap/board/leaderboard.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/core/progress.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "program.hpp"

namespace {

using cmap::ExitCode;

constexpr const char* kDescription =
    "Evaluates the maps of several methods on several sequences and writes the tables of a paper: tables.md,\n"
    "tables.csv, tables.tex and index.html with pictures, and the report of every map below pairs/. What is done\n"
    "already is kept: a run that was stopped goes on where it was. Maps that fail are marked x and stop nothing;\n"
    "missing ones are -. Methods that are not distinguishable share their mark: \"bootstrap\": 1000 among the "
    "parameters\n"
    "tests what the grid's phases do not.";

constexpr const char* kExample =
    "Example:\n"
    "  cmap_leaderboard benchmarks/leaderboard/samples.json --data-root data_samples -o leaderboard\n"
    "\n"
    "The manifest is JSON, comments allowed; paths are below the data root:\n"
    "  {\"version\": 1,\n"
    "   \"parameters\": {\"lcr-radius\": 0.5, \"bootstrap\": 1000},\n"
    "   \"sequences\": [{\"name\": \"town\", \"reference\": \"town/reference.ply\"}],\n"
    "   \"methods\": [{\"name\": \"Ours\", \"maps\": {\"town\": \"town/estimate.ply\"}, \"failed\": []}],\n"
    "   \"published\": \"paper.json\"}\n"
    "\n"
    "Exit codes: 0 every pair is done, missing or failed as marked; 2 wrong usage or manifest, or an output that "
    "cannot be\n"
    "written; 3 no data root; 70 internal error.";

struct Arguments {
  std::string manifest, data_root = ".", output;
  cmap::LeaderboardLook look;
  cmap::CommonArguments common;
};

void add_options(cmap::CommandLine& line, Arguments& a) {
  line.add("MANIFEST", a.manifest, "FILE.json", "sequences, methods and their maps").required();
  line.add("--data-root", a.data_root, "DIR", "folder that the manifest's paths start from [.]").not_empty();
  line.add("-o,--output", a.output, "DIR", "folder to write to; its results are used again").required().not_empty();
  line.add_flag("--plain-ranking", a.look.plain_ranking,
                "mark best and second best by value alone, whatever noise does to them");
  line.add_flag("--bands", a.look.bands, "in tables.tex, too, write the spread over the grid's phases behind a value");
  cmap::add_common_options(line, a.common, "no tables, no progress");
}

ExitCode run(const Arguments& arguments) {
  const cmap::ExecutionScope scope({.threads = arguments.common.threads});
  const cmap::LeaderboardManifest manifest = cmap::read_manifest(arguments.manifest);
  cmap::LeaderboardRun leaderboard{arguments.data_root, arguments.output, [](const std::string&) {}, {}};
  std::optional<cmap::ProgressBar> bar;  // of the pair at hand
  if (!arguments.common.quiet) {
    leaderboard.log = [&](const std::string& line) {
      bar.reset();
      fmt::print(stderr, "{}\n", line);
    };
    leaderboard.execution.progress = [&](std::string_view stage, double done) {
      if (!bar) bar.emplace(true);
      bar->update(stage, done);
    };
  }
  const std::vector<cmap::LeaderboardPair> pairs = cmap::evaluate_leaderboard(manifest, leaderboard);
  const cmap::LeaderboardDocuments documents = cmap::typeset_leaderboard(manifest, pairs, arguments.look);
  cmap::write_documents(documents, arguments.output);
  if (!arguments.common.quiet) cmap::print(documents.text);
  return ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  cmap::CommandLine line("cmap_leaderboard", kDescription, kExample);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(arguments); });
}
