#include "pair_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "cmap/board/comparison.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/json_text.hpp"
#include "cmap/io/output_folder.hpp"
#include "cmap/io/sha256.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kRecord = "pair.json";
constexpr const char* kRecordSchema = "cmap.leaderboard_pair/1";

Json parsed_file(const fs::path& path) {
  Json json;
  read_json_file(path, "a file of a leaderboard", [&](const Json& content) { json = content; });
  return json;
}

}  // namespace

std::string sha256_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> block(std::size_t{1} << 20);
  Sha256 hash;
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash.add(std::as_bytes(std::span(block.data(), static_cast<std::size_t>(file.gcount()))));
  }
  if (!file.eof()) throw InputError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  return hash.finish();
}

std::string folder_name(const std::string& name) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+().";
  std::string folder;
  for (char c : name) {
    const bool is_plain = kPlain.find(c) != kPlain.npos && !(folder.empty() && c == '.');
    folder += is_plain ? std::string(1, c) : fmt::format("~{:02X}", static_cast<unsigned char>(c));
  }
  return folder;
}

void remove_temporaries(const fs::path& folder, const std::vector<std::string>& files) {
  std::error_code missing;
  std::vector<fs::path> left;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing)) {
    const std::string name = entry.path().filename().string();
    const auto is_of = [&](const std::string& file) { return name.starts_with("." + file + "."); };
    if (name.ends_with(".tmp") && std::ranges::any_of(files, is_of)) left.push_back(entry.path());
  }
  for (const fs::path& path : left) fs::remove(path, missing);
}

PairFolder::PairFolder(fs::path folder, std::vector<std::string> files)
    : folder_(std::move(folder)), files_(std::move(files)) {
  make_folder(folder_);
  std::vector<std::string> all = files_;
  all.emplace_back(kRecord);
  remove_temporaries(folder_, all);
}

std::optional<Json> PairFolder::load(const Json& key, std::string& reason) const {
  reason.clear();
  if (!is_there(folder_ / kRecord)) return std::nullopt;
  try {
    const Json record = parsed_file(folder_ / kRecord);
    if (record.at("schema") != kRecordSchema) throw UsageError("of another version");
    if (record.at("key") != key) {
      const bool same_tool = record.at("key").at("tool") == key.at("tool");
      throw UsageError(same_tool ? "of other maps or parameters" : "of another version");
    }
    for (const std::string& file : files_) {
      if (record.at("files").at(file) != sha256_of_file(folder_ / file)) {
        throw UsageError(fmt::format("damaged: {} is not as it was written", file));
      }
    }
    Json report = parsed_file(folder_ / "report.json");
    check_report(report, "report.json");
    return report;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    reason = error.what();
  } catch (const Json::exception&) {
    reason = fmt::format("damaged: {} is not as it was written", kRecord);
  }
  return std::nullopt;
}

void PairFolder::store(const Json& key, const std::vector<File>& files) const {
  OutputFiles outputs;
  for (const File& file : files) outputs.add(folder_ / file.name, file.write);
  outputs.commit();
  Json record{{"schema", kRecordSchema}, {"key", key}, {"files", Json::object()}};
  for (const File& file : files) record["files"][file.name] = sha256_of_file(folder_ / file.name);
  OutputFile output(folder_ / kRecord);
  output.write(record.dump(2) + "\n");
  output.commit();
}

}  // namespace cmap
