#include "cmap/report/file_names.hpp"

#include <filesystem>
#include <vector>

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// Where the path that begins at `begin` ends: at the quote that it stands in, or before what no path has.
std::size_t end_of_path(std::string_view text, std::size_t begin) {
  const char before = begin > 0 ? text[begin - 1] : ' ';
  const bool is_quoted = before == '\'' || before == '"';
  const std::size_t end = is_quoted ? text.find(before, begin) : text.find_first_of(" \t\n'\"()[],;", begin);
  return std::min(end, text.size());
}

bool begins_path(std::string_view text, std::size_t at) {
  constexpr std::string_view kBefore = " \t\n'\"()[],;=:";
  const bool is_url = text.substr(at).starts_with("//");
  return text[at] == '/' && !is_url && (at == 0 || kBefore.find(text[at - 1]) != kBefore.npos);
}

/// What is left of an absolute path: its last part, with the slash after it that says that it is a folder.
std::string_view last_part(std::string_view path) {
  const std::size_t slash = path.find_last_of('/', path.size() - 2);
  return slash == path.npos || slash == 0 ? path : path.substr(slash + 1);
}

void replace_all(std::string& text, const std::string& what) {
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos;) text.erase(at, what.size());
}

Json shortened(const Json& value, const std::vector<std::string>& folders) {
  if (value.is_string()) {
    std::string text = value.get<std::string>();
    for (const std::string& folder : folders) replace_all(text, folder);
    return with_file_names(text);
  }
  if (!value.is_structured()) return value;
  Json copy = value;
  for (Json& member : copy) member = shortened(member, folders);
  return copy;
}

}  // namespace

std::string with_file_names(std::string_view text) {
  std::string shortened;
  for (std::size_t at = 0; at < text.size();) {
    if (!begins_path(text, at)) {
      shortened += text[at++];
      continue;
    }
    const std::size_t end = end_of_path(text, at);
    shortened += last_part(text.substr(at, end - at));
    at = end;
  }
  return shortened;
}

Json shared_report(const Json& report) {
  std::vector<std::string> folders;
  for (const Json& input : report.at("inputs")) {
    const std::string folder = std::filesystem::path(input.at("path").get<std::string>()).parent_path().string();
    if (folder.size() > 1 && folder.front() == '/') folders.push_back(folder + "/");
  }
  return shortened(report, folders);
}

}  // namespace cmap
