#include "recordings/containers/rosbag2_metadata.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cmap/core/error.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/line_reader.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// A scalar without its quotation marks.
std::string scalar(std::string_view text) {
  text = trimmed(text);
  const bool is_quoted =
      text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
  return std::string(is_quoted ? text.substr(1, text.size() - 2) : text);
}

/// The value of "key: value".
bool value_of(std::string_view line, std::string_view key, std::string& value) {
  if (!line.starts_with(key) || line.substr(key.size(), 1) != ":") return false;
  value = scalar(line.substr(key.size() + 1));
  return true;
}

/// "[a.db3, b.db3]"
std::vector<std::string> items_in_brackets(std::string_view text) {
  std::vector<std::string> items;
  text = text.substr(1, text.size() - 2);
  while (!trimmed(text).empty()) {
    const std::size_t comma = std::min(text.find(','), text.size());
    items.push_back(scalar(text.substr(0, comma)));
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return items;
}

}  // namespace

Rosbag2Metadata read_rosbag2_metadata(const fs::path& path) {
  ByteSource source(path);
  LineReader lines(source);
  Rosbag2Metadata metadata;
  std::vector<std::string> names;
  bool is_in_list = false;
  std::string_view raw;
  while (lines.next(raw)) {
    const std::string_view line = trimmed(raw);
    if (is_in_list && line.starts_with("- ")) {
      names.push_back(scalar(line.substr(2)));
      continue;
    }
    std::string value;
    is_in_list = value_of(line, "relative_file_paths", value);
    if (value.starts_with('[') && value.ends_with(']')) names = items_in_brackets(value);
    value_of(line, "storage_identifier", metadata.storage);
    value_of(line, "compression_format", metadata.compression);
    value_of(line, "compression_mode", metadata.compression_mode);
  }
  if (names.empty()) source.fail("lists no file (relative_file_paths): no recording of rosbag2, or an empty one");
  for (const std::string& name : names) {
    const fs::path file = path.parent_path() / name;
    if (!is_file(file)) source.fail("lists {}, which is not there", name);
    metadata.files.push_back(file);
  }
  return metadata;
}

}  // namespace cmap
