#include "cmap/report/parameters.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "report/report_testing.hpp"

namespace cmap {
namespace parameters_test {

using Json = nlohmann::ordered_json;

Json definition(const char* name) { return {{"$ref", std::string("#/definitions/") + name}}; }

/// What the schema of reports says of an option's value.
struct Schema {
  const OptionField& field;

  Json operator()(const NumberValue&) const { return definition("positive"); }
  Json operator()(const OptionalNumberValue& v) const {
    Json schema{{"type", {"number", "null"}}};
    if (v.range.above_low) schema["exclusiveMinimum"] = v.range.low;
    return schema;
  }
  Json operator()(const CountValue& v) const {
    return v.range.least == 0 ? definition("count") : Json{{"type", "integer"}, {"minimum", v.range.least}};
  }
  Json operator()(const FlagValue&) const { return {{"type", "boolean"}}; }
  Json operator()(const BytesValue&) const {
    return {{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 0}, {"maximum", 255}}}};
  }
  Json operator()(const ChoiceValue& v) const {
    // Methods of registration are files of their own: the schema does not change with them.
    if (std::string(field.name) == "align") return {{"type", "string"}, {"minLength", 1}};
    return {{"enum", v.names}};
  }
  Json operator()(const NumberListValue& v) const {
    if (!v.can_be_unset) return {{"type", "array"}, {"items", definition("positive")}, {"minItems", 1}};
    return {{"type", {"array", "null"}}, {"items", definition("number")}, {"minItems", 6}, {"maxItems", 6}};
  }
  Json operator()(const NameListValue& v) const {
    Json schema{{"type", "array"}, {"items", {{"type", "string"}, {"minLength", 1}}}};
    if (!v.get().empty()) schema["minItems"] = 1;  // its default has a name
    return schema;
  }
  Json operator()(const auto&) const { return "unlike any option so far"; }
};

TEST(Parameters, AreWhatTheSchemaOfReportsSays) {
  std::ifstream file(test::source_path("configs/report.schema.json"));
  const Json schema = Json::parse(file).at("properties").at("parameters");
  EvaluationOptions options;
  const OptionFields fields = option_fields(options);
  EXPECT_EQ(schema.at("required"), Json(names_of(fields)));
  EXPECT_EQ(schema.at("properties").size(), fields.size());
  for (const OptionField& field : fields) {
    EXPECT_EQ(nlohmann::json(schema.at("properties").value(field.name, Json())),
              nlohmann::json(std::visit(Schema{field}, field.value)))
        << field.name;
  }
}

}  // namespace parameters_test
}  // namespace cmap
