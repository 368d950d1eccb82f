#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cmap/io/output_file.hpp"

namespace cmap {

/// SHA-256 of a file. Throws InputError where it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

/// A name as a folder on any file system, different for different names: "V-Sim(3)", "a~2Fb".
std::string folder_name(const std::string& name);

/// Removes what killed runs left in this folder under temporary names of these files.
void remove_temporaries(const std::filesystem::path& folder, const std::vector<std::string>& files);

/// The files of one evaluated pair. Its record, written last, says what they belong to and how they must read, so that
/// a run that was killed, files that were damaged, and other inputs are told apart from what can be used.
class PairFolder {
 public:
  struct File {
    std::string name;
    std::function<void(OutputFile&)> write;
  };

  /// The files that a complete folder has, among them report.json.
  PairFolder(std::filesystem::path folder, std::vector<std::string> files);

  /// The report stored for this key; else `reason` says why not, empty where there is nothing.
  std::optional<nlohmann::ordered_json> load(const nlohmann::ordered_json& key, std::string& reason) const;

  /// Writes all files, then the record.
  void store(const nlohmann::ordered_json& key, const std::vector<File>& files) const;

 private:
  std::filesystem::path folder_;
  std::vector<std::string> files_;
};

}  // namespace cmap
