#include <array>
#include <vector>

#include "bytes/ascii_rows.hpp"
#include "clouds/cloud_format.hpp"
#include "clouds/largest_part.hpp"
#include "cmap/io/number_text.hpp"

// VisualSFM's "N-View Match" (ccwu.me/vsfm/doc.html, "Output format"), which COLMAP and others write, too.
namespace cmap {
namespace {

using NvmPoints = std::vector<RowStage::Row>;

/// The next line that holds something; what stands there for the message that it is missing.
std::string_view next_filled(LineReader& lines, const char* what) {
  for (std::string_view line; lines.next(line);) {
    if (line.find_first_not_of(" \t") != std::string_view::npos) return line;
  }
  lines.source().fail("truncated: the file ends where {} should be", what);
}

std::uint64_t read_count(LineReader& lines, const char* what) {
  std::string_view line = next_filled(lines, what);
  const std::string_view token = next_token(line);
  unsigned long long count = 0;
  if (!parse_number(token, count) || !next_token(line).empty()) {
    lines.fail("'{}' is not {}", token.substr(0, 40), what);
  }
  return count;
}

/// "x y z r g b n" and n measurements, which are passed over.
RowStage::Row read_point(LineReader& lines) {
  std::string_view line = next_filled(lines, "a point");
  std::array<double, 6> values{};
  for (double& value : values) {
    const std::string_view token = next_token(line);
    if (token.empty()) lines.fail("a point needs x y z r g b");
    if (!parse_number(token, value)) lines.fail("'{}' is not a number", token.substr(0, 40));
  }
  return {{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
}

/// The points of each model that has some. A model of 0 cameras, or the file's end, is behind the last one.
std::vector<NvmPoints> read_models(LineReader& lines) {
  std::vector<NvmPoints> models;
  for (std::string_view line; lines.next(line);) {
    std::string_view rest = line;
    const std::string_view token = next_token(rest);
    if (token.empty()) continue;
    unsigned long long n_cameras = 0;
    if (!parse_number(token, n_cameras)) lines.fail("'{}' is not the number of cameras", token.substr(0, 40));
    if (n_cameras == 0) break;
    for (unsigned long long i = 0; i < n_cameras; ++i) next_filled(lines, "a camera");
    const std::uint64_t n_points = read_count(lines, "the number of points");
    NvmPoints points;
    for (std::uint64_t i = 0; i < n_points; ++i) points.push_back(read_point(lines));
    if (!points.empty()) models.push_back(std::move(points));
  }
  return models;
}

/// The largest model.
PointCloud read_nvm(ByteSource& source, FileInfo& info) {
  info.format = "NVM";
  LineReader lines(source);
  std::string_view header;
  lines.next(header);
  const std::vector<NvmPoints> models = read_models(lines);
  if (models.empty()) source.fail("holds no points");
  std::vector<std::size_t> sizes;
  for (const NvmPoints& model : models) sizes.push_back(model.size());
  const NvmPoints& largest = models[largest_part(sizes, "models", info)];
  CloudBuilder builder(source, {true, {ColorStorage::kSeparate}}, largest.size());
  RowStage stage(builder, true);
  for (const RowStage::Row& row : largest) stage.add(row);
  stage.flush();
  return builder.finish(info);
}

}  // namespace

namespace formats {

extern constinit const CloudFormat nvm{
    .name = "NVM",
    .listed = "NVM",
    .by_content = [](const FileStart& start) { return start.text && start.bytes.starts_with("NVM_V3"); },
    .read = without_options<read_nvm>};

}  // namespace formats

}  // namespace cmap
