#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cmap/core/execution.hpp"
#include "cmap/eval/options.hpp"

namespace cmap {

/// Numbers that somebody published, in the units of FORMATS, "Leaderboard manifests": shown as published, never mixed
/// with computed ones.
struct PublishedScores {
  /// Value by (sequence, method) in the order of the file; no value for a system that failed.
  struct Entry {
    std::string sequence, method;
    std::optional<double> value;
  };
  struct Metric {
    std::string id;
    std::vector<Entry> entries;
  };
  /// A table of its own: sequence and variant against the metrics of registration.
  struct Registration {
    std::string sequence, variant;
    std::map<std::string, std::optional<double>> values;  ///< by metric id
  };

  std::string source;
  std::vector<Metric> metrics;
  std::vector<Registration> registration;
  std::map<std::string, double> color_scale;  ///< by sequence: what 1 in unit RGB is in the printed color distance
  std::vector<std::string> notes;
};

struct LeaderboardSequence {
  std::string name;
  std::string reference;  ///< below the data root
};

struct LeaderboardMethod {
  std::string name;
  std::map<std::string, std::string> maps;  ///< by sequence, below the data root
  std::set<std::string> failed;             ///< sequences that the method has no map for because it failed
};

struct LeaderboardManifest {
  EvaluationOptions options;
  std::vector<LeaderboardSequence> sequences;
  std::vector<LeaderboardMethod> methods;
  std::optional<PublishedScores> published;
};

/// Reads a manifest (FORMATS; comments allowed). `published` may be the name of a file beside the manifest. Throws
/// UsageError naming file, key and reason: unknown keys, names that repeat or are not there, paths that leave the data
/// root, numbers that are none.
LeaderboardManifest read_manifest(const std::filesystem::path& path);

/// A published part: the object in a manifest, or the content of a file.
PublishedScores parse_published(const nlohmann::ordered_json& json);

enum class PairState { kDone, kMissing, kFailed };

/// What became of one method on one sequence.
struct LeaderboardPair {
  std::string sequence, method;
  PairState state = PairState::kMissing;
  std::string reason;             ///< why there is no report
  nlohmann::ordered_json report;  ///< where done
  std::string folder;             ///< of its files, below the output folder, with slashes
  bool has_figure = false;
};

/// Where a run reads and writes, and whom it tells.
struct LeaderboardRun {
  std::filesystem::path data_root, output;
  std::function<void(const std::string&)> log;  ///< one line for each pair and each surprise
  Execution execution;                          ///< its sink gets the stages of the pair at hand
};

/// Evaluates every pair that the output folder does not hold yet: pairs/SEQUENCE/METHOD/ gets report.json, report.html,
/// figure.png (where figures are built) and, last, pair.json: the content of the inputs, parameters and version that
/// the others belong to, and their checksums. What does not match is evaluated again. Each pair has
/// a process of its own: one that cannot be evaluated, or dies, has failed and the others go on. Killed at any moment
/// and started again, it leaves the same bytes. Throws OutputError where something cannot be written or another run is
/// writing there, UsageError where an input is below the output, InputError where the data root is no folder.
std::vector<LeaderboardPair> evaluate_leaderboard(const LeaderboardManifest& manifest, const LeaderboardRun& run);

/// All tables, the same for the same pairs.
struct LeaderboardDocuments {
  std::string text;  ///< one value for each metric: of the first threshold where there are several
  std::string markdown, csv, latex, html;
};

/// How tables look.
struct LeaderboardLook {
  bool plain_ranking = false;  ///< best and second best by value alone
  bool bands = false;          ///< in LaTeX, too: the spread over the grid's phases behind a value
};

/// Best and second best of each column are marked as in a comparison (comparison.hpp): computed methods that are not
/// distinguishable share their mark, what nobody tested, as all that was published, has one of its own.
LeaderboardDocuments typeset_leaderboard(const LeaderboardManifest& manifest, const std::vector<LeaderboardPair>& pairs,
                                         const LeaderboardLook& look = {});

/// Writes tables.md, tables.csv, tables.tex and index.html.
void write_documents(const LeaderboardDocuments& documents, const std::filesystem::path& output);

}  // namespace cmap
