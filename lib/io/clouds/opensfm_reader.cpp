#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "bytes/ascii_rows.hpp"
#include "clouds/cloud_format.hpp"
#include "clouds/largest_part.hpp"

namespace cmap {
namespace {

using OpenSfmJson = nlohmann::json;

OpenSfmJson parse(ByteSource& source) {
  std::string text(source.size(), '\0');
  source.read(std::as_writable_bytes(std::span(text)), "the file");
  try {
    return OpenSfmJson::parse(text);
  } catch (const OpenSfmJson::exception& error) {
    source.fail("is no complete JSON: {}", error.what());
  }
}

std::size_t n_points(const OpenSfmJson& reconstruction) {
  if (!reconstruction.is_object()) return 0;
  const auto points = reconstruction.find("points");
  return points == reconstruction.end() || !points->is_object() ? 0 : points->size();
}

/// The largest of the file's reconstructions.
const OpenSfmJson& choose(const ByteSource& source, const OpenSfmJson& file, FileInfo& info) {
  if (!file.is_array() || file.empty()) source.fail("an OpenSfM reconstruction is an array of objects");
  std::vector<std::size_t> sizes;
  for (const OpenSfmJson& reconstruction : file) sizes.push_back(n_points(reconstruction));
  const OpenSfmJson& largest = file[largest_part(sizes, "reconstructions", info)];
  if (n_points(largest) == 0) source.fail("its reconstructions hold no points");
  return largest;
}

std::array<double, 3> triple(const ByteSource& source, const std::string& id, const OpenSfmJson& point,
                             const char* key) {
  const auto values = point.is_object() ? point.find(key) : point.end();
  std::array<double, 3> triple{};
  const bool good = point.is_object() && values != point.end() && values->is_array() && values->size() == 3 &&
                    std::all_of(values->begin(), values->end(), [](const OpenSfmJson& v) { return v.is_number(); });
  if (!good) source.fail("point '{}': '{}' is not three numbers", id.substr(0, 40), key);
  for (std::size_t k = 0; k < 3; ++k) triple[k] = (*values)[k].get<double>();
  return triple;
}

bool is_opensfm(const FileStart& start) {
  const std::size_t first = start.bytes.find_first_not_of(" \t\r\n");
  return start.text && first != std::string_view::npos && start.bytes[first] == '[' &&
         start.bytes.find("\"cameras\"") != std::string_view::npos &&
         start.bytes.find("\"shots\"") != std::string_view::npos;
}

PointCloud read_opensfm(ByteSource& source, FileInfo& info) {
  info.format = "OpenSfM reconstruction";
  const OpenSfmJson file = parse(source);
  const OpenSfmJson& points = choose(source, file, info)["points"];
  CloudBuilder builder(source, {true, {ColorStorage::kSeparate}}, points.size());
  RowStage stage(builder, true);
  for (const auto& [id, point] : points.items()) {
    stage.add({triple(source, id, point, "coordinates"), triple(source, id, point, "color")});
  }
  stage.flush();
  return builder.finish(info);
}

}  // namespace

namespace formats {

extern constinit const CloudFormat opensfm{
    .name = "OpenSfM", .listed = "OpenSfM", .by_content = is_opensfm, .read = without_options<read_opensfm>};

}  // namespace formats

}  // namespace cmap
