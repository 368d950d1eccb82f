#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "child_process.hpp"
#include "cmap/board/leaderboard.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/version.hpp"
#include "cmap/eval/protocol.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/option_text.hpp"
#include "cmap/io/output_folder.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/report/figure_module.hpp"
#include "cmap/report/html_report.hpp"
#include "cmap/report/parameters.hpp"
#include "cmap/report/report.hpp"
#include "pair_folder.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// The command that gives the same report, from the data root.
std::string command_for(const std::string& reference, const std::string& estimate, const EvaluationOptions& options) {
  std::vector<std::string> words{"cmap_eval", reference, estimate};
  EvaluationOptions given = options, defaults;
  std::ranges::move(arguments_for(option_fields(given), option_fields(defaults)), std::back_inserter(words));
  return shell_command(words);
}

/// Turns whatever goes wrong with a pair's maps into its failure.
template <class Work>
auto of_pair(Work&& work) {
  try {
    return work();
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    throw WorkFailure(error.what());
  }
}

struct Evaluated {
  EvaluatedPair evaluation;
  Json report;
};

/// Evaluates pairs one after the other.
class Runner {
 public:
  Runner(const LeaderboardManifest& manifest, const LeaderboardRun& run);

  std::vector<LeaderboardPair> evaluate_all();

 private:
  void say(const std::string& text) const { run_.log(place_ + text); }
  fs::path file(const std::string& path) const { return run_.data_root / path; }
  LeaderboardPair evaluate_pair(const LeaderboardSequence& sequence, const LeaderboardMethod& method);
  /// Fills in report and state; WorkFailure where that cannot be.
  void fill(LeaderboardPair& pair, const std::string& reference, const std::string& estimate);
  /// What a report depends on.
  Json key_for(const std::string& reference, const std::string& estimate);
  const std::string& hash_of_reference(const std::string& path);
  /// Evaluates and stores, in a process of its own.
  void evaluate_into(const PairFolder& folder, const Json& key, const std::string& reference,
                     const std::string& estimate) const;
  Evaluated evaluate_files(const std::string& reference, const std::string& estimate) const;
  void store(const PairFolder& folder, const Json& key, const Evaluated& evaluated) const;
  /// Outputs do not depend on where the data lies.
  std::string without_root(std::string text) const;

  const LeaderboardManifest& manifest_;
  const LeaderboardRun& run_;
  std::optional<FigureModule> figures_;
  std::vector<std::string> files_{"report.json", "report.html"};
  std::map<std::string, std::string> reference_hashes_;  ///< each reference serves all methods
  std::string place_;                                    ///< "[3/25] AMtown01 / Ours: "
};

Runner::Runner(const LeaderboardManifest& manifest, const LeaderboardRun& run) : manifest_(manifest), run_(run) {
  try {
    figures_.emplace();
    files_.emplace_back("figure.png");
  } catch (const UnsupportedError& error) {
    say(fmt::format("no pictures: {}", error.what()));
  }
}

std::string Runner::without_root(std::string text) const {
  const std::string root = file("").string();
  for (std::size_t at = 0; (at = text.find(root, at)) != text.npos;) text.erase(at, root.size());
  return text;
}

const std::string& Runner::hash_of_reference(const std::string& path) {
  std::string& hash = reference_hashes_[path];
  if (hash.empty()) hash = sha256_of_file(file(path));
  return hash;
}

Json Runner::key_for(const std::string& reference, const std::string& estimate) {
  return {{"tool", {{"version", kVersion}, {"schema", kReportSchema}}},
          {"reference", {{"path", reference}, {"sha256", hash_of_reference(reference)}}},
          {"estimate", {{"path", estimate}, {"sha256", sha256_of_file(file(estimate))}}},
          {"parameters", to_json(manifest_.options)}};
}

Evaluated Runner::evaluate_files(const std::string& reference_path, const std::string& estimate_path) const {
  auto [reference, estimate] =
      read_both(file(reference_path), file(estimate_path), read_options(manifest_.options, true));
  reference.info.path = reference_path;  // as in the manifest
  estimate.info.path = estimate_path;
  const InputDescription about_reference = describe(reference), about_estimate = describe(estimate);
  Evaluated evaluated{evaluate_by_protocol(std::move(reference.cloud), std::move(estimate.cloud), manifest_.options, {},
                                           {.progress = run_.execution.progress}),
                      {}};
  evaluated.report = make_report(about_reference, about_estimate, evaluated.evaluation, {});
  // Times would make two runs differ.
  evaluated.report["run"] = {{"command", command_for(reference_path, estimate_path, manifest_.options)}};
  return evaluated;
}

void Runner::store(const PairFolder& folder, const Json& key, const Evaluated& evaluated) const {
  std::vector<PairFolder::File> files{
      {"report.html", [&](OutputFile& out) { write_html_report(evaluated.report, evaluated.evaluation, out); }},
      {"report.json", [&](OutputFile& out) { out.write(evaluated.report.dump(2) + "\n"); }}};
  if (figures_) {
    files.push_back({"figure.png", [&](OutputFile& out) { figures_->write(evaluated.evaluation, "figure.png", out); }});
  }
  folder.store(key, files);
}

void Runner::evaluate_into(const PairFolder& folder, const Json& key, const std::string& reference,
                           const std::string& estimate) const {
  const auto start = std::chrono::steady_clock::now();
  const Evaluated evaluated = of_pair([&] { return evaluate_files(reference, estimate); });
  for (const char* which : {"reference", "estimate"}) {
    if (evaluated.report.at("inputs").at(which).at("sha256") != key.at(which).at("sha256")) {
      throw WorkFailure(fmt::format("the {} changed while it was read", which));
    }
  }
  store(folder, key, evaluated);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  say(fmt::format("evaluated in {:.1f} s", seconds.count()));
}

void Runner::fill(LeaderboardPair& pair, const std::string& reference, const std::string& estimate) {
  const Json key = of_pair([&] { return key_for(reference, estimate); });
  const PairFolder folder(run_.output / pair.folder, files_);
  std::string why_not;
  std::optional<Json> stored = folder.load(key, why_not);
  if (stored) {
    say("done before");
  } else {
    if (!why_not.empty()) say(fmt::format("what is stored is not used, it is {}", why_not));
    run_apart([&] { evaluate_into(folder, key, reference, estimate); });
    stored = folder.load(key, why_not);
    if (!stored) throw WorkFailure(fmt::format("what was stored is {}", why_not));
  }
  pair.report = std::move(*stored);
}

LeaderboardPair Runner::evaluate_pair(const LeaderboardSequence& sequence, const LeaderboardMethod& method) {
  LeaderboardPair pair{sequence.name, method.name, PairState::kMissing, "", nullptr, "", false};
  pair.folder = fmt::format("pairs/{}/{}", folder_name(sequence.name), folder_name(method.name));
  if (method.failed.contains(sequence.name)) {
    pair.state = PairState::kFailed;
    pair.reason = "has no map, as the manifest says";
    return pair;
  }
  const auto map = method.maps.find(sequence.name);
  if (map == method.maps.end()) {
    pair.reason = "the manifest names no map";
    return pair;
  }
  for (const std::string& path : {sequence.reference, map->second}) {
    std::error_code error;
    if (fs::exists(file(path), error)) continue;
    pair.reason = fmt::format("there is no file {}", path);
    return pair;
  }
  try {
    fill(pair, sequence.reference, map->second);
    pair.state = PairState::kDone;
    pair.has_figure = figures_.has_value();
  } catch (const WorkFailure& failure) {
    pair.state = PairState::kFailed;
    pair.reason = without_root(failure.what());
  }
  return pair;
}

std::vector<LeaderboardPair> Runner::evaluate_all() {
  std::vector<LeaderboardPair> pairs;
  const std::size_t n = manifest_.sequences.size() * manifest_.methods.size();
  for (const LeaderboardSequence& sequence : manifest_.sequences) {
    for (const LeaderboardMethod& method : manifest_.methods) {
      place_ = fmt::format("[{}/{}] {} / {}: ", pairs.size() + 1, n, sequence.name, method.name);
      const LeaderboardPair& pair = pairs.emplace_back(evaluate_pair(sequence, method));
      if (pair.state == PairState::kFailed) say("failed: " + pair.reason);
      if (pair.state == PairState::kMissing) say("missing: " + pair.reason);
    }
  }
  return pairs;
}

/// Inputs are never overwritten.
void refuse_inputs_below(const fs::path& output, const LeaderboardManifest& manifest, const fs::path& data_root) {
  const fs::path folder = place_of_file(output);
  const auto refuse = [&](const std::string& path) {
    const fs::path relative = place_of_file(data_root / path).lexically_relative(folder);
    if (!relative.empty() && *relative.begin() != "..") {
      throw UsageError(fmt::format("{}: holds the input {}; choose another output folder", output.string(), path));
    }
  };
  for (const LeaderboardSequence& sequence : manifest.sequences) refuse(sequence.reference);
  for (const LeaderboardMethod& method : manifest.methods) {
    for (const auto& [sequence, path] : method.maps) refuse(path);
  }
}

}  // namespace

std::vector<LeaderboardPair> evaluate_leaderboard(const LeaderboardManifest& manifest, const LeaderboardRun& run) {
  const ExecutionScope scope(run.execution);
  if (!is_folder(run.data_root)) {
    throw InputError(fmt::format("{}: the data root is no folder", run.data_root.string()));
  }
  refuse_inputs_below(run.output, manifest, run.data_root);
  make_folder(run.output);
  const FolderLock lock(run.output);  // two at a time would only do the work twice
  return Runner(manifest, run).evaluate_all();
}

void write_documents(const LeaderboardDocuments& documents, const fs::path& output) {
  const std::vector<std::pair<std::string, const std::string*>> files{{"tables.md", &documents.markdown},
                                                                      {"tables.csv", &documents.csv},
                                                                      {"tables.tex", &documents.latex},
                                                                      {"index.html", &documents.html}};
  std::vector<std::string> names;
  for (const auto& [name, text] : files) names.push_back(name);
  remove_temporaries(output, names);
  OutputFiles outputs;
  for (const auto& [name, text] : files) {
    outputs.add(output / name, [content = text](OutputFile& out) { out.write(*content); });
  }
  outputs.commit();
}

}  // namespace cmap
