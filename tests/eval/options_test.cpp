#include "cmap/eval/options.hpp"

#include <nlohmann/json.hpp>

#include "cmap/eval/configuration.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "cmap/io/option_text.hpp"
#include "cmap/report/parameters.hpp"
#include "eval/eval_testing.hpp"
#include "io/io_testing.hpp"

namespace cmap {
namespace options_test {

using Json = nlohmann::ordered_json;
using test::refusal_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Json parsed(const char* json) { return Json::parse(json); }

void set(EvaluationOptions& options, const std::string& name, const std::string& text) {
  for (const OptionField& field : option_fields(options)) {
    if (field.name == name) return set_from_text(field, text);
  }
  throw std::runtime_error("no option " + name);
}

/// The text of a value that a field does not have.
struct OtherText {
  const char* name;

  std::string operator()(const NumberValue& v) const { return std::to_string(2.0 * *v.value); }
  std::string operator()(const OptionalNumberValue&) const { return "0.25"; }
  std::string operator()(const CountValue& v) const { return std::to_string(*v.value + 1); }
  std::string operator()(const FlagValue& v) const { return *v.value ? "false" : "true"; }
  std::string operator()(const BytesValue&) const { return "2,6"; }
  std::string operator()(const ChoiceValue& v) const { return v.names.at((v.place() + 1) % v.names.size()); }
  std::string operator()(const NumberListValue&) const { return "1,2,3,4,5,6"; }
  std::string operator()(const NameListValue&) const { return std::string(name) == "as" ? "mpeg,open3d" : "AC"; }
  std::string operator()(const auto&) const { throw std::runtime_error(std::string(name) + ": no other value known"); }
};

TEST(Options, EachIsSetFromTextAndFromWhatAReportSaysOfIt) {
  const Json defaults = to_json(EvaluationOptions{});
  for (std::size_t i = 0; i < defaults.size(); ++i) {
    EvaluationOptions options, again;
    const OptionField field = option_fields(options).at(i);
    SCOPED_TRACE(field.name);
    set_from_text(field, std::visit(OtherText{field.name}, field.value));
    const Json changed = to_json(options);
    EXPECT_NE(changed.at(field.name), defaults.at(field.name));
    Json expected = defaults;
    expected[field.name] = changed.at(field.name);
    EXPECT_EQ(changed, expected) << "this option and no other";
    apply_config(again, Json{{field.name, changed.at(field.name)}}.dump(), "a.json");
    EXPECT_EQ(to_json(again), changed);
  }
}

TEST(Options, ThoseThatAreNotTheDefaultMakeACommandLine) {
  EvaluationOptions options, defaults;
  EXPECT_TRUE(arguments_for(option_fields(options), option_fields(defaults)).empty());
  options.align = test::aligner("gicp");
  options.crop = Box3d{{-1, -2, -3}, {1, 2, 3.5}};
  options.keep_noise = true;
  EXPECT_THAT(arguments_for(option_fields(options), option_fields(defaults)),
              ::testing::ElementsAre("--crop", "-1.0,-2.0,-3.0,1.0,2.0,3.5", "--align", "gicp", "--keep-noise"));
}

TEST(Options, DefaultsAreThoseOfTheDefinitions) {
  const Json defaults = to_json(EvaluationOptions{});
  const Json expected = parsed(R"({
    "thresholds": [0.2, 0.1, 0.08, 0.05, 0.01], "overlap-distance": 1.0, "lcr-tau": 0.1, "lcr-radius": 0.5,
    "ccs-voxel": 0.1, "ccs-singletons": "zero", "ccs-min-points": 2, "cw-voxel": 1.0, "cw-min-points": 10,
    "awd-voxel": 3.0, "awd-min-points": 100, "scs-radius": 5, "grid-phases": "8", "no-levels": false, "mme-radius": 0.1, "mme-min-neighbors": 10, "align": "none"})");
  for (const auto& [name, value] : expected.items()) EXPECT_EQ(defaults.at(name), value) << name;
}

TEST(Options, TheirRecordIsAConfiguration) {
  EvaluationOptions all_set;
  for (const OptionField& field : option_fields(all_set)) {
    set_from_text(field, std::visit(OtherText{field.name}, field.value));
  }
  for (const EvaluationOptions& original : {EvaluationOptions{}, all_set}) {
    EXPECT_FALSE(to_json(original).at("metrics").empty()) << "defaults have a name, too";
    EvaluationOptions again;
    apply_config(again, to_json(original).dump(), "a report");
    EXPECT_EQ(to_json(again), to_json(original));
    EXPECT_EQ(select_metrics(again).ids, select_metrics(original).ids);
    EXPECT_EQ(select_metrics(again).color_is_required, select_metrics(original).color_is_required);
  }
}

TEST(Options, AChoiceOfNumbersMayBeWrittenAsOne) {
  EvaluationOptions options;
  apply_config(options, R"({"grid-phases": 27})", "a file");
  EXPECT_EQ(options.grid_phases, GridPhases::kTwentySeven);
  apply_config(options, R"({"grid-phases": "1"})", "a file");
  EXPECT_EQ(options.grid_phases, GridPhases::kOne);
  EXPECT_THROW(apply_config(options, R"({"grid-phases": 9})", "a file"), UsageError);
}

TEST(Options, TakeWholeNumbersInAnyNotation) {
  EvaluationOptions options;
  set(options, "awd-min-points", "1e3");
  EXPECT_EQ(options.awd_min_points, 1000U);
  set(options, "lcr-radius", "1");
  EXPECT_EQ(options.lcr_radius_m, 1.0);
}

TEST(Options, ListsMayHaveBlanks) {
  EvaluationOptions options;
  set(options, "thresholds", "0.2, 0.1");
  EXPECT_EQ(options.thresholds_m, (std::vector<double>{0.2, 0.1}));
}

TEST(Options, ALaterOneWins) {
  EvaluationOptions options;
  apply_preset(options, "indoor");
  apply_config(options, R"({"lcr-radius": 0.07})", "a.json");
  EXPECT_EQ(options.lcr_radius_m, 0.07);
  EXPECT_EQ(options.awd_voxel_m, 0.5) << "the preset's others stay";
}

/// A value that is refused, and what the message says beside the option's name.
struct Refused {
  const char* name;
  const char* value;
  const char* says;
  friend void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name << " " << refused.value; }
};

class BadJson : public ::testing::TestWithParam<Refused> {};

TEST_P(BadJson, IsRefusedByNameValueAndRule) {
  const auto& [name, json, says] = GetParam();
  EvaluationOptions options;
  const std::string config = "{\"" + std::string(name) + "\": " + json + "}";
  EXPECT_THAT(refusal_of<UsageError>([&] { apply_config(options, config, "my.json"); }),
              AllOf(StartsWith("my.json: " + std::string(name) + ": "), HasSubstr(says)));
  EXPECT_EQ(to_json(options), to_json(EvaluationOptions{})) << "nothing was set";
}

INSTANTIATE_TEST_SUITE_P(
    Options, BadJson,
    ::testing::Values(
        Refused{"metrics", R"("color")", R"("color" is not a list of words)"},
        Refused{"metrics", "[1]", "[1] is not a list of words"}, Refused{"metrics", "[]", "names no metric"},
        Refused{"metrics", R"(["colour"])", R"("colour" is unknown; did you mean color?; groups are )"},
        Refused{"thresholds", "0.2", "0.2 is not a list of numbers"},
        Refused{"thresholds", "[]", "[] is not a list of numbers"},
        Refused{"thresholds", R"(["a"])", R"("a" is not a number)"},
        Refused{"thresholds", "[0.2, 0]", "[0.2,0] must be above 0 throughout"},
        Refused{"thresholds", "[0.2, 0.2]", "[0.2,0.2] names a threshold twice"},
        Refused{"overlap-distance", "0", "0 must be above 0"}, Refused{"lcr-tau", "-0.1", "-0.1 must be above 0"},
        Refused{"lcr-radius", R"("0.5")", R"("0.5" is not a number)"},
        Refused{"lcr-radius", "null", "null is not a number"}, Refused{"lcr-radius", "-0.5", "-0.5 must be above 0"},
        Refused{"lcr-curve", "1", "1 is neither true nor false"}, Refused{"ccs-voxel", "0.0", "must be above 0"},
        Refused{"ccs-min-points", "1", "1 is not a whole number from 2 to"},
        Refused{"ccs-singletons", R"("leave")", R"("leave" is none of zero, exclude, refuse)"},
        Refused{"ccs-min-points", "2.5", "2.5 is not a whole number"},
        Refused{"awd-voxel", "[3]", "[3] is not a number"}, Refused{"awd-min-points", "-5", "-5 is not a whole number"},
        Refused{"awd-min-points", "10000000000", "is not a whole number from 2 to 1000000000"},
        Refused{"scs-radius", "0", "0 is not a whole number from 1 to 1000"},
        Refused{"scs-radius", "1001", "1001 is not a whole number from 1 to 1000"},
        Refused{"mme-radius", "false", "false is not a number"}, Refused{"mme-min-neighbors", "1", "from 2 to"},
        Refused{"color-max-distance", "-1", "-1 must be above 0"}, Refused{"voxel", "0", "0 must be above 0"},
        Refused{"crop", "[0, 0, 0]", "is not xmin,ymin,zmin,xmax,ymax,zmax"},
        Refused{"crop", "[0, 0, 0, 1, -1, 1]", "has a maximum below its minimum"},
        Refused{"as", R"(["cloud_compare"])",
                R"("cloud_compare" is unknown; did you mean cloudcompare?; tools are color-map-evaluation, clo)"},
        Refused{"as", R"("open3d")", "is not a list of words"},
        Refused{"index", R"("kdtree")", R"("kdtree" is none of bvh, flann)"}));

class BadText : public ::testing::TestWithParam<Refused> {};

TEST_P(BadText, IsRefusedByNameValueAndRule) {
  const auto& [name, text, says] = GetParam();
  EvaluationOptions options;
  EXPECT_THAT(refusal_of<UsageError>([&] { set(options, name, text); }),
              AllOf(StartsWith(std::string(name) + ": "), HasSubstr(says)));
  EXPECT_EQ(to_json(options), to_json(EvaluationOptions{})) << "nothing was set";
}

INSTANTIATE_TEST_SUITE_P(
    Options, BadText,
    ::testing::Values(Refused{"metrics", "", "names no metric"},
                      Refused{"metrics", "color,nope", R"("nope" is unknown)"},
                      Refused{"thresholds", "", "is not a list of numbers"},
                      Refused{"thresholds", "0.2,,0.1", R"("" is not a number)"},
                      Refused{"thresholds", "0.2,", R"("" is not a number)"},
                      Refused{"thresholds", "0.2,x", R"("x" is not a number)"},
                      Refused{"thresholds", "0.2,-0.1", "must be above 0 throughout"},
                      Refused{"lcr-radius", "", R"("" is not a number)"},
                      Refused{"lcr-radius", "0.5m", R"("0.5m" is not a number)"},
                      Refused{"lcr-radius", "-0.5", "-0.5 must be above 0"}, Refused{"lcr-radius", "inf", "inf"},
                      Refused{"lcr-radius", "nan", "nan"}, Refused{"lcr-radius", "1e999", "1e999"},
                      Refused{"lcr-curve", "yes", R"("yes" is neither true nor false)"},
                      Refused{"awd-min-points", "2.5", "2.5 is not a whole number"},
                      Refused{"awd-min-points", "1e30", "is not a whole number"},
                      Refused{"crop", "0,0,0,1,1", "is not xmin,ymin,zmin,xmax,ymax,zmax"},
                      Refused{"as", "pcl", R"("pcl" is unknown)"},
                      Refused{"index", "BVH", R"("BVH" is none of bvh, flann; did you mean bvh?)"}));

TEST(Config, MayHaveComments) {
  EvaluationOptions options;
  apply_config(options, "// why\n{\n  /* the radius */ \"lcr-radius\": 0.3  // meters\n}\n", "a.json");
  EXPECT_EQ(options.lcr_radius_m, 0.3);
}

TEST(Config, RefusesAnUnknownKeyByName) {
  EvaluationOptions options;
  for (const char* key : {"lcr_radius", "--lcr-radius", "threads", ""}) {
    const std::string config = "{\"" + std::string(key) + "\": 1}";
    EXPECT_THAT(refusal_of<UsageError>([&] { apply_config(options, config, "my.json"); }),
                AllOf(StartsWith("my.json: "), HasSubstr("unknown key \"" + std::string(key) + "\"")));
  }
}

TEST(Config, RefusesAKeyGivenTwice) {
  EvaluationOptions options;
  EXPECT_THAT(refusal_of<UsageError>([&] { apply_config(options, R"({"voxel": 1, "voxel": 2})", "my.json"); }),
              AllOf(StartsWith("my.json: "), HasSubstr("voxel"), HasSubstr("twice")));
}

TEST(Config, RefusesWhatIsNoObject) {
  EvaluationOptions options;
  EXPECT_THAT(refusal_of<UsageError>([&] { apply_config(options, "[1]", "my.json"); }),
              AllOf(StartsWith("my.json: "), HasSubstr("expected a JSON object")));
  for (const char* broken : {"", "{", "{\"voxel\": 1,}", "{\"voxel\": nan}", "lcr-radius: 0.5"}) {
    EXPECT_THAT(refusal_of<UsageError>([&] { apply_config(options, broken, "my.json"); }),
                AllOf(StartsWith("my.json: "), HasSubstr("line 1, column")))
        << broken;
  }
}

TEST(Config, IsReadFromAFile) {
  const testing::TempFolder folder;
  EvaluationOptions options;
  apply_config_file(options, folder.write("a.json", R"({"voxel": 0.5})"));
  EXPECT_EQ(options.voxel_m, 0.5);
  for (const std::filesystem::path& path : {folder / "none.json", folder.path()}) {
    EXPECT_THAT(refusal_of<UsageError>([&] { apply_config_file(options, path); }), StartsWith(path.string() + ": "));
  }
}

struct PresetCase {
  const char* name;
  const char* differs_from_the_defaults_in;
  friend void PrintTo(const PresetCase& preset, std::ostream* out) { *out << preset.name; }
};

class Presets : public ::testing::TestWithParam<PresetCase> {};

TEST_P(Presets, HaveTheirValues) {
  EvaluationOptions options;
  apply_preset(options, GetParam().name);
  Json expected = to_json(EvaluationOptions{});
  expected.update(parsed(GetParam().differs_from_the_defaults_in));
  EXPECT_EQ(to_json(options), expected);
}

TEST_P(Presets, AreTheFilesOfConfigs) {
  const std::string name = GetParam().name;
  EvaluationOptions compiled_in, from_file;
  apply_preset(compiled_in, name);
  apply_config_file(from_file, test::source_path(("configs/" + name + ".json").c_str()));
  EXPECT_EQ(to_json(compiled_in), to_json(from_file));
}

INSTANTIATE_TEST_SUITE_P(
    Options, Presets,
    ::testing::Values(
        PresetCase{"paper", "{}"}, PresetCase{"mapeval", "{}"},
        PresetCase{"indoor", R"({"thresholds": [0.1, 0.05, 0.02, 0.01, 0.005], "awd-voxel": 0.5, "lcr-radius": 0.05,
                                 "ccs-voxel": 0.05, "cw-voxel": 0.2})"},
        PresetCase{"outdoor", R"({"thresholds": [0.5, 0.3, 0.2, 0.1, 0.05], "awd-voxel": 2.0, "lcr-radius": 0.25,
                                  "ccs-voxel": 0.2})"},
        PresetCase{"aerial", R"({"thresholds": [1.0, 0.5, 0.3, 0.2, 0.1], "awd-voxel": 4.0, "lcr-radius": 0.5,
                                 "ccs-voxel": 0.5, "cw-voxel": 2.0})"}));

TEST(Preset, NamesAreListed) {
  EXPECT_EQ(preset_names(), (std::vector<std::string>{"paper", "indoor", "outdoor", "aerial", "mapeval"}));
}

TEST(Preset, PaperRestatesEveryDefaultThatItNames) {
  EvaluationOptions options;
  options.thresholds_m = {1.0};
  options.overlap_distance_m = options.lcr_tau = options.lcr_radius_m = options.ccs_voxel_m = options.awd_voxel_m = 9.0;
  options.ccs_min_points = options.awd_min_points = options.scs_radius_voxels = 9;
  options.ccs_singletons = Singletons::kRefuse;
  apply_preset(options, "paper");
  EXPECT_EQ(to_json(options), to_json(EvaluationOptions{})) << "it resets whatever was set before";
}

TEST(Preset, AnUnknownOneNamesTheOthers) {
  EvaluationOptions options;
  EXPECT_THAT(refusal_of<UsageError>([&] { apply_preset(options, "urban"); }),
              AllOf(HasSubstr("\"urban\" is unknown"), HasSubstr("paper, indoor, outdoor, aerial, mapeval")));
}

}  // namespace options_test
}  // namespace cmap
