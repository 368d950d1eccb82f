#include <filesystem>

#include "cmap/board/leaderboard.hpp"
#include "cmap/eval/configuration.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "cmap/io/json_text.hpp"
#include "manifest_json.hpp"

namespace cmap {
namespace {

using Json = ManifestJson;
namespace fs = std::filesystem;

/// Names head tables and name folders.
std::string name_in(const Json& value, const std::string& place) {
  const std::string name = text_in(value, place);
  constexpr std::size_t kLongest = 80;
  if (name.empty()) throw UsageError(fmt::format("{}: the name is empty", place));
  if (name.size() > kLongest) throw UsageError(fmt::format("{}: the name is longer than {} bytes", place, kLongest));
  const bool has_control = std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  if (has_control) throw UsageError(fmt::format("{}: the name has control characters", place));
  return name;
}

std::string path_in(const Json& value, const std::string& place) {
  const std::string text = text_in(value, place);
  const fs::path path = fs::path(text).lexically_normal();
  if (text.empty()) throw UsageError(fmt::format("{}: the path is empty", place));
  if (path.is_absolute() || *path.begin() == "..") {
    throw UsageError(fmt::format("{}: {} must be a path below the data root", place, value.dump()));
  }
  return text;
}

template <class List>
void require_new_name(const List& list, const std::string& name, const std::string& place) {
  for (const auto& other : list) {
    if (other.name == name) throw UsageError(fmt::format("{}: \"{}\" is there twice", place, name));
  }
}

std::vector<LeaderboardSequence> sequences_in(const Json& json) {
  std::vector<LeaderboardSequence> sequences;
  for (const Json& entry : list_in(json, "sequences")) {
    const std::string place = fmt::format("sequences[{}]", sequences.size());
    require_keys(entry, place, {"name", "reference"});
    const std::string name = name_in(required(entry, place, "name"), place + ".name");
    require_new_name(sequences, name, place);
    sequences.push_back({name, path_in(required(entry, place, "reference"), place + ".reference")});
  }
  if (sequences.empty()) throw UsageError("sequences: there is none");
  return sequences;
}

void require_sequence(const std::vector<LeaderboardSequence>& sequences, const std::string& name,
                      const std::string& place) {
  const bool known = std::ranges::any_of(sequences, [&](const LeaderboardSequence& s) { return s.name == name; });
  if (!known) throw UsageError(fmt::format("{}: \"{}\" is no sequence of this manifest", place, name));
}

LeaderboardMethod method_in(const Json& entry, const std::string& place,
                            const std::vector<LeaderboardSequence>& sequences) {
  require_keys(entry, place, {"name", "maps", "failed"});
  LeaderboardMethod method;
  method.name = name_in(required(entry, place, "name"), place + ".name");
  if (entry.contains("maps")) {
    for (const auto& [sequence, path] : object_in(entry.at("maps"), place + ".maps").items()) {
      require_sequence(sequences, sequence, place + ".maps");
      method.maps[sequence] = path_in(path, fmt::format("{}.maps.{}", place, sequence));
    }
  }
  if (!entry.contains("failed")) return method;
  for (const Json& item : list_in(entry.at("failed"), place + ".failed")) {
    const std::string sequence = text_in(item, place + ".failed");
    require_sequence(sequences, sequence, place + ".failed");
    if (!method.failed.insert(sequence).second) {
      throw UsageError(fmt::format("{}.failed: \"{}\" is there twice", place, sequence));
    }
    if (method.maps.contains(sequence)) {
      throw UsageError(fmt::format("{}: \"{}\" is in both maps and failed", place, sequence));
    }
  }
  return method;
}

std::vector<LeaderboardMethod> methods_in(const Json& json, const std::vector<LeaderboardSequence>& sequences) {
  std::vector<LeaderboardMethod> methods;
  for (const Json& entry : list_in(json, "methods")) {
    const std::string place = fmt::format("methods[{}]", methods.size());
    LeaderboardMethod method = method_in(entry, place, sequences);
    require_new_name(methods, method.name, place);
    methods.push_back(std::move(method));
  }
  if (methods.empty()) throw UsageError("methods: there is none");
  return methods;
}

/// The object itself, or what the file beside the manifest holds.
PublishedScores published_in(const Json& json, const fs::path& manifest) {
  if (!json.is_string()) return parse_published(json);
  PublishedScores published;
  const fs::path path = manifest.parent_path() / json.get<std::string>();
  read_json_file(path, "published scores", [&](const Json& content) { published = parse_published(content); });
  return published;
}

LeaderboardManifest manifest_in(const Json& json, const fs::path& path) {
  require_keys(json, "the manifest", {"version", "parameters", "sequences", "methods", "published"});
  const Json& version = required(json, "the manifest", "version");
  if (version != 1)
    throw UsageError(fmt::format("version: {} is unknown; this program reads version 1", version.dump()));
  LeaderboardManifest manifest;
  // The pages of single maps show recall against tau, as with cmap_eval --html.
  manifest.options.lcr_curve = true;
  if (json.contains("parameters")) apply_config(manifest.options, json.at("parameters").dump(), "parameters");
  if (manifest.options.align.kind == AlignKind::kTrajectory)
    throw UsageError("parameters: align: a manifest has no trajectories");
  manifest.sequences = sequences_in(required(json, "the manifest", "sequences"));
  manifest.methods = methods_in(required(json, "the manifest", "methods"), manifest.sequences);
  if (json.contains("published")) manifest.published = published_in(json.at("published"), path);
  return manifest;
}

}  // namespace

LeaderboardManifest read_manifest(const fs::path& path) {
  LeaderboardManifest manifest;
  read_json_file(path, "a manifest", [&](const Json& json) { manifest = manifest_in(json, path); });
  return manifest;
}

}  // namespace cmap
