#include "bytes/file_start.hpp"

#include <algorithm>
#include <cctype>

#include "cmap/core/spelling.hpp"
#include "cmap/io/line_reader.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

bool is_text(std::string_view start) {
  return std::none_of(start.begin(), start.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 && c != '\n' && c != '\r' && c != '\t' && c != '\v' && c != '\f';
  });
}

}  // namespace

std::vector<std::string_view> FileStart::lines(std::size_t n) const {
  std::vector<std::string_view> lines;
  std::string_view rest = bytes;
  while (lines.size() < n && !rest.empty()) {
    const std::size_t end = rest.find_first_of("\r\n");
    if (end == std::string_view::npos && !whole) break;
    lines.push_back(rest.substr(0, end));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(rest.substr(end).starts_with("\r\n") ? end + 2 : end + 1);
  }
  return lines;
}

FileStart file_start(ByteSource& source) {
  constexpr std::size_t kTextBytes = 4096;
  const auto window = source.peek(std::min<std::uint64_t>(FileStart::kBytes, source.size()));
  FileStart start;
  const std::filesystem::path path(source.name());
  start.name = lower_case(path.filename().string());
  start.extension = lower_case(path.extension().string());
  start.bytes = without_byte_order_mark(
      {reinterpret_cast<const char*>(window.data()), std::min(FileStart::kBytes, window.size())});
  start.size = source.size();
  start.whole = source.size() <= FileStart::kBytes;
  start.text = is_text(start.bytes.substr(0, kTextBytes));
  return start;
}

std::vector<std::string_view> tokens_of(std::string_view line, std::size_t most) {
  std::vector<std::string_view> tokens;
  while (tokens.size() < most) {
    const std::string_view token = next_token(line);
    if (token.empty()) break;
    tokens.push_back(token);
  }
  return tokens;
}

bool parse_numbers(const std::vector<std::string_view>& tokens, std::vector<double>& values) {
  values.assign(tokens.size(), 0.0);
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (!parse_number(tokens[i], values[i])) return false;
  }
  return true;
}

}  // namespace cmap
