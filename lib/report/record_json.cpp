#include "cmap/report/record_json.hpp"

#include <cmath>

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

Json number_json(const Number& number) {
  if (const auto* value = std::get_if<double>(&number.value)) return json_number(*value);
  if (const auto* count = std::get_if<std::uint64_t>(&number.value)) return *count;
  if (const auto* word = std::get_if<std::string>(&number.value)) return *word;
  Json list = Json::array();
  for (const double value : std::get<std::vector<double>>(number.value)) list.push_back(json_number(value));
  return list;
}

}  // namespace

Json json_number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json record_json(const Record& record) {
  Json json = Json::object();
  if (record.threshold_m) json["threshold_m"] = *record.threshold_m;
  if (record.value) json["value"] = json_number(*record.value);
  for (const Number& number : record.numbers) json[number.name] = number_json(number);
  for (const Number& parameter : record.parameters) json["parameters"][parameter.name] = number_json(parameter);
  for (const NamedRecord& part : record.parts) json[part.name] = record_json(part.record);
  for (const RecordRows& list : record.rows) {
    Json& rows = json[list.name] = Json::array();
    for (const Record& row : list.rows) rows.push_back(record_json(row));
  }
  return json;
}

}  // namespace cmap
