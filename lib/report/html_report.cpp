#include "cmap/report/html_report.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cmap/core/round_number.hpp"
#include "report/base64.hpp"
#include "report/distribution.hpp"
#include "report/embedded_file.hpp"
#include "report/packed_map.hpp"
#include "report/thinning.hpp"

// The page built from web/; its data belongs where kDataPlace stands.
CMAP_EMBED(html_page, CMAP_HTML_PAGE)

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kDataPlace = "<!--CMAP_DATA-->";
constexpr std::size_t kPointsOfPage = 300'000;

std::string gzipped(const std::string& bytes) {
  constexpr int kGzip = 15 + 16, kMemory = 8;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::runtime_error("zlib cannot start");
  }
  std::string compressed(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(compressed.data());
  stream.avail_out = static_cast<uInt>(compressed.size());
  const int result = deflate(&stream, Z_FINISH);
  compressed.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw std::runtime_error("zlib cannot compress");
  return compressed;
}

/// JSON that cannot end the script element around it.
std::string inlined(const Json& json) {
  std::string text;
  for (char c : json.dump()) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

Json definitions(const std::vector<MetricRecord>& metrics) {
  Json list = Json::array();
  for (const MetricRecord& record : metrics) {
    const MetricInfo& metric = *record.info;
    list.push_back(
        {{"id", metric.id}, {"title", metric.title}, {"group", metric.group}, {"definition", metric.definition}});
  }
  return list;
}

Json distribution_json(const char* id, const char* title, const char* unit, const Distribution& distribution,
                       const MapPair& pair) {
  const auto direction = [](const char* name, const char* label, const DirectedDistribution& d, std::size_t total) {
    return Json{{"id", name}, {"title", label}, {"counts", d.counts}, {"beyond", d.n_beyond}, {"total", total}};
  };
  return {{"id", id},
          {"title", title},
          {"unit", unit},
          {"bin_width", distribution.bin_width},
          {"directions",
           {direction("estimate_to_reference", "estimate to reference", distribution.estimate_to_reference,
                      pair.estimate.size()),
            direction("reference_to_estimate", "reference to estimate", distribution.reference_to_estimate,
                      pair.reference.size())}}};
}

Json height_layer(const char* map, const char* title, const PackedMap& packed) {
  const auto [low, high] = packed.central_z_m;
  return {{"id", fmt::format("{}-height", map)},
          {"title", title},
          {"map", map},
          {"kind", "scalar"},
          {"field", "z"},
          {"color_map", "viridis"},
          {"range", {low, high > low ? high : low + 1.0}},
          {"unit", "m"}};
}

Json map_layer(const IndexedMap& map, const char* id, const char* title, const PackedMap& packed) {
  if (!map.has_color()) return height_layer(id, title, packed);
  return {{"id", id}, {"title", title}, {"map", id}, {"kind", "color"}};
}

Json error_layer(const char* id, const char* title, const char* field, const char* color_map, const char* unit,
                 const Distribution& errors) {
  return {{"id", id},
          {"title", title},
          {"map", "estimate"},
          {"kind", "scalar"},
          {"field", field},
          {"color_map", color_map},
          {"range", {0.0, round_number_above(errors.estimate_to_reference.p95)}},
          {"unit", unit}};
}

Json recall_layer(const IndexedMap& reference) {
  Json classes = Json::array();
  for (const RecallClassLook& look : kRecallClassLooks) {
    if (&look == &look_of(RecallClass::kNoColor) && reference.n_without_color == 0) continue;
    classes.push_back({{"label", look.label}, {"color", {look.color[0], look.color[1], look.color[2]}}});
  }
  return {{"id", "lcr"},        {"title", "Local color recall"},
          {"map", "reference"}, {"kind", "classes"},
          {"field", "lcr"},     {"classes", classes}};
}

/// Half of the page's points for each map; what a small one leaves goes to the other.
std::array<std::size_t, 2> points_of_maps(const MapPair& pair) {
  const std::size_t reference = pair.reference.size(), estimate = pair.estimate.size(), half = kPointsOfPage / 2;
  return {std::min(reference, kPointsOfPage - std::min(estimate, half)),
          std::min(estimate, kPointsOfPage - std::min(reference, half))};
}

std::string file_name(const Json& input) {
  return std::filesystem::path(input.at("path").get<std::string>()).filename().string();
}

Json named(const char* id, const char* title, const PackedMap& packed) {
  Json map{{"id", id}, {"title", title}};
  map.update(packed.description);
  return map;
}

/// What the page shows beside the report, and the bytes of its maps.
struct PageData {
  Json page;
  std::string points;
};

PageData page_data(const Json& report, const Evaluation& evaluation) {
  const MapPair& pair = evaluation.pair;
  const LocalColorRecall* recall = evaluation.recall ? &*evaluation.recall : nullptr;
  const auto [n_reference, n_estimate] = points_of_maps(pair);
  const PackedMap reference =
      pack_map(pair.reference_to_estimate(), recall, evenly_spread_slots(pair.reference.index.points, n_reference));
  const PackedMap estimate =
      pack_map(pair.estimate_to_reference(), nullptr, evenly_spread_slots(pair.estimate.index.points, n_estimate));
  Json distributions = Json::array();
  Json layers{map_layer(pair.reference, "reference", "Reference", reference),
              map_layer(pair.estimate, "estimate", "Estimate", estimate)};
  if (recall != nullptr) layers.push_back(recall_layer(pair.reference));
  if (pair.has_color()) {
    const Distribution colors = distribution_of(pair, &NearestPairs::color_distance);
    const bool every_color = pair.reference.n_without_color + pair.estimate.n_without_color == 0;
    layers.push_back(error_layer("color-distance",
                                 every_color ? "Color distance" : "Color distance (0 where a color is missing)",
                                 "color_distance", "inferno", "unit RGB", colors));
    distributions.push_back(
        distribution_json("color_distance", "Color distance to the nearest point", "unit RGB", colors, pair));
  }
  const Distribution distances = distribution_of(pair, &NearestPairs::distance_m);
  layers.push_back(error_layer("distance", "Distance to the reference", "distance", "viridis", "m", distances));
  distributions.insert(distributions.begin(),
                       distribution_json("distance", "Distance to the nearest point", "m", distances, pair));
  if (pair.estimate.has_color()) layers.push_back(height_layer("estimate", "Height", estimate));
  const Json& inputs = report.at("inputs");
  return {{{"title", fmt::format("{} against {}", file_name(inputs.at("estimate")), file_name(inputs.at("reference")))},
           {"metrics", definitions(evaluation.metrics)},
           {"distributions", distributions},
           {"maps", {named("reference", "Reference", reference), named("estimate", "Estimate", estimate)}},
           {"layers", layers}},
          reference.bytes + estimate.bytes};
}

/// Of one map: its colors, where it has them, and its height.
PageData page_data(const Json& report, const MapEvaluation& evaluation) {
  const IndexedMap& map = evaluation.map;
  const PackedMap packed = pack_map(map, evenly_spread_slots(map.index.points, kPointsOfPage));
  Json layers = Json::array();
  if (map.has_color()) layers.push_back(map_layer(map, "estimate", "Map", packed));
  layers.push_back(height_layer("estimate", "Height", packed));
  return {{{"title", file_name(report.at("inputs").at("estimate"))},
           {"metrics", definitions(evaluation.metrics)},
           {"distributions", Json::array()},
           {"maps", Json::array({named("estimate", "Map", packed)})},
           {"layers", layers}},
          packed.bytes};
}

void write_page(const Json& report, const PageData& data, OutputFile& file) {
  const std::string_view page = html_page();
  const std::size_t place = page.find(kDataPlace);
  if (place == page.npos) throw std::logic_error("the page has no place for its data");
  const auto script = [&](const char* type, const char* id, const std::string& text) {
    file.write(fmt::format("<script type=\"{}\" id=\"{}\">", type, id));
    file.write(text);
    file.write("</script>\n");
  };
  file.write(page.substr(0, place));
  script("application/json", "cmap-report", inlined(report));
  script("application/json", "cmap-page", inlined(data.page));
  script("text/plain", "cmap-points", base64(gzipped(data.points)));
  file.write(page.substr(place + kDataPlace.size()));
}

}  // namespace

void write_html_report(const Json& report, const Evaluation& evaluation, OutputFile& file) {
  write_page(report, page_data(report, evaluation), file);
}

void write_html_report(const Json& report, const MapEvaluation& evaluation, OutputFile& file) {
  write_page(report, page_data(report, evaluation), file);
}

}  // namespace cmap
