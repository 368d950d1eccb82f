#include "cmap/report/html_report.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cmap/io/file_place.hpp"
#include "cmap/report/base64.hpp"
#include "cmap/report/embedded_file.hpp"
#include "cmap/report/file_names.hpp"
#include "distribution.hpp"
#include "packed_map.hpp"
#include "page_layers.hpp"
#include "thinning.hpp"

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

Json definitions(const MetricRecords& metrics) {
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

/// Half of the page's points for each map; what a small one leaves goes to the other.
std::array<std::size_t, 2> points_of_maps(const MapPair& pair) {
  const std::size_t reference = pair.reference.size(), estimate = pair.estimate.size(), half = kPointsOfPage / 2;
  return {std::min(reference, kPointsOfPage - std::min(estimate, half)),
          std::min(estimate, kPointsOfPage - std::min(reference, half))};
}

std::string name_of(const Json& input) { return file_name(input.at("path").get<std::string>()); }

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

PageData page_data(const Json& report, const EvaluatedPair& evaluation) {
  const MapPair& pair = evaluation.pair;
  const LocalColorRecall* recall = evaluation.recall ? &*evaluation.recall : nullptr;
  const auto [n_reference, n_estimate] = points_of_maps(pair);
  const PackedMap reference =
      pack_map(pair.reference_to_estimate(), recall, evenly_spread_slots(pair.reference.index.points, n_reference));
  const PackedMap estimate =
      pack_map(pair.estimate_to_reference(), nullptr, evenly_spread_slots(pair.estimate.index.points, n_estimate));
  Json distributions = Json::array();
  Json layers{map_layer(pair.reference, "reference", "Reference"), map_layer(pair.estimate, "estimate", "Estimate")};
  if (evaluation.recall) layers.push_back(recall_layer(*evaluation.recall));
  if (pair.has_color()) {
    const Distribution colors = distribution_of(pair, &NearestPairs::color_distance);
    layers.push_back(color_distance_layer(colors));
    distributions.push_back(
        distribution_json("color_distance", "Color distance to the nearest point", "unit RGB", colors, pair));
  }
  const Distribution distances = distribution_of(pair, &NearestPairs::distance_m);
  layers.push_back(distance_layer(distances));
  distributions.insert(distributions.begin(),
                       distribution_json("distance", "Distance to the nearest point", "m", distances, pair));
  if (pair.estimate.has_color()) layers.push_back(height_layer(pair.estimate, "estimate", "Height"));
  const Json& inputs = report.at("inputs");
  return {{{"title", fmt::format("{} against {}", name_of(inputs.at("estimate")), name_of(inputs.at("reference")))},
           {"metrics", definitions(evaluation.metrics)},
           {"distributions", distributions},
           {"maps", {named("reference", "Reference", reference), named("estimate", "Estimate", estimate)}},
           {"layers", layers}},
          reference.bytes + estimate.bytes};
}

/// Of one map: its colors, where it has them, and its height.
PageData page_data(const Json& report, const EvaluatedMap& evaluation) {
  const IndexedMap& map = evaluation.map;
  const PackedMap packed = pack_map(map, evenly_spread_slots(map.index.points, kPointsOfPage));
  Json layers = Json::array();
  if (map.has_color()) layers.push_back(map_layer(map, "estimate", "Map"));
  layers.push_back(height_layer(map, "estimate", "Height"));
  return {{{"title", name_of(report.at("inputs").at("estimate"))},
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
  script("application/json", "cmap-report", inlined(shared_report(report)));
  script("application/json", "cmap-page", inlined(data.page));
  script("text/plain", "cmap-points", base64(gzipped(data.points)));
  file.write(page.substr(place + kDataPlace.size()));
}

}  // namespace

void write_html_report(const Json& report, const EvaluatedPair& evaluation, OutputFile& file) {
  write_page(report, page_data(report, evaluation), file);
}

void write_html_report(const Json& report, const EvaluatedMap& evaluation, OutputFile& file) {
  write_page(report, page_data(report, evaluation), file);
}

}  // namespace cmap
