#include "clouds/cloud_format.hpp"

#include <fmt/ranges.h>

#include <span>
#include <vector>

#include "clouds/foreign_formats.hpp"
#include "poses/transform_numbers.hpp"

namespace cmap {
namespace {

/// Refuses a transform in brackets, as JSON or as NumPy prints it; rows of bare numbers are the text reader's.
void refuse_transform(const ByteSource& source, const FileStart& start) {
  constexpr std::size_t kMostBytes = 4096;
  if (!start.text || !start.whole || start.bytes.size() > kMostBytes || start.bytes.starts_with('#') ||
      start.bytes.find_first_of("[{") == std::string_view::npos) {
    return;
  }
  try {
    ByteSource bytes(source.name(), std::as_bytes(std::span(start.bytes)));
    parse_transform(bytes);
  } catch (const Error&) {
    return;
  }
  source.fail("holds one 4x4 or 3x4 matrix, a transform, and no point cloud; --transform takes it");
}

using Recognizes = bool (*CloudFormat::*)(const FileStart&);

const CloudFormat* find(const FileStart& start, Recognizes recognizes) {
  for (const CloudFormat* format : cloud_formats()) {
    if (format->*recognizes != nullptr && (format->*recognizes)(start)) return format;
  }
  return nullptr;
}

}  // namespace

std::string readable_formats() {
  std::vector<std::string_view> names;
  for (const CloudFormat* format : cloud_formats()) {
    if (!format->listed.empty()) names.push_back(format->listed);
  }
  return fmt::format("{} and {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
}

const CloudFormat& detect_format(ByteSource& source) {
  const FileStart start = file_start(source);
  const auto refuse = [&](std::string_view what) { source.fail("{}; {} can be read", what, readable_formats()); };
  refuse_transform(source, start);
  if (const auto what = foreign_content(start)) refuse(*what);
  if (const CloudFormat* format = find(start, &CloudFormat::by_content)) return *format;
  if (const auto what = foreign_extension(start)) refuse(*what);
  if (const CloudFormat* format = find(start, &CloudFormat::by_name)) return *format;
  source.fail("is of no known format; {} can be read", readable_formats());
}

}  // namespace cmap
