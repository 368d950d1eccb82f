#include "cmap/eval/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cmap/align/align.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/eval/metric_catalog.hpp"
#include "cmap/io/json_text.hpp"
#include "cmap/peers/peer_tool.hpp"
#include "presets.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(const char* name, const Json& value, const char* rule) {
  // The command line holds whole numbers as floating-point ones: 300, not 300.0.
  const std::string shown = value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
  throw UsageError(fmt::format("{}: {} {}", name, shown, rule));
}

double number(const char* name, const Json& value) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) refuse(name, value, "is not a number");
  return value.get<double>();
}

double positive(const char* name, const Json& value) {
  const double v = number(name, value);
  if (!(v > 0.0)) refuse(name, value, "must be above 0");
  return v;
}

std::uint64_t count(const char* name, const Json& value, std::uint64_t lowest, std::uint64_t highest) {
  if (!value.is_number_integer() || value.get<double>() < static_cast<double>(lowest) ||
      value.get<double>() > static_cast<double>(highest)) {
    refuse(name, value, fmt::format("is not a whole number from {} to {}", lowest, highest).c_str());
  }
  return value.get<std::uint64_t>();
}

constexpr std::uint64_t kMostPoints = 1'000'000'000;

std::vector<double> numbers(const char* name, const Json& value) {
  if (!value.is_array() || value.empty()) refuse(name, value, "is not a list of numbers");
  std::vector<double> list;
  for (const Json& item : value) list.push_back(number(name, item));
  return list;
}

std::vector<double> thresholds(const char* name, const Json& value) {
  std::vector<double> list = numbers(name, value);
  for (double v : list) {
    if (!(v > 0.0)) refuse(name, value, "must be above 0 throughout");
    if (std::ranges::count(list, v) > 1) refuse(name, value, "names a threshold twice");
  }
  return list;
}

std::vector<std::string> words(const char* name, const Json& value) {
  const auto is_word = [](const Json& item) { return item.is_string(); };
  if (!value.is_array() || !std::ranges::all_of(value, is_word)) refuse(name, value, "is not a list of words");
  return value.get<std::vector<std::string>>();
}

std::vector<std::string> tools(const char* name, const Json& value) {
  std::vector<std::string> list = words(name, value);
  for (const std::string& tool : list) {
    if (peer_tool(tool) == nullptr) {
      refuse(name, tool,
             fmt::format("is unknown{}; tools are {}", did_you_mean(tool, peer_names()), fmt::join(peer_names(), ", "))
                 .c_str());
    }
  }
  return list;
}

Singletons singletons_kind(const char* name, const Json& value) {
  for (Singletons s : {Singletons::kZero, Singletons::kExclude, Singletons::kRefuse}) {
    if (value == singletons_name(s)) return s;
  }
  refuse(name, value, "is none of zero, exclude, refuse");
}

std::vector<std::string> metric_list(const char* name, const Json& value) {
  EvaluationOptions checked;
  checked.metrics = words(name, value);
  if (checked.metrics.empty()) refuse(name, value, "names no metric");
  select_metrics(checked);
  return checked.metrics;
}

/// An empty list means all.
std::vector<std::uint8_t> classes(const char* name, const Json& value) {
  if (!value.is_array()) refuse(name, value, "is not a list of classes");
  std::vector<std::uint8_t> list;
  for (const Json& item : value) {
    const double v = number(name, item);
    if (v != std::floor(v) || v < 0.0 || v > 255.0) refuse(name, item, "is not a whole number from 0 to 255");
    list.push_back(static_cast<std::uint8_t>(v));
  }
  return list;
}

Box3d crop_box(const char* name, const Json& value) {
  const std::vector<double> v = numbers(name, value);
  if (v.size() != 6) refuse(name, value, "is not xmin,ymin,zmin,xmax,ymax,zmax");
  const Box3d box{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
  if ((box.max.array() < box.min.array()).any()) refuse(name, value, "has a maximum below its minimum");
  return box;
}

IndexKind index_kind(const char* name, const Json& value) {
  if (value == "bvh") return IndexKind::kBvh;
  if (value == "flann") return IndexKind::kFlann;
  refuse(name, value, "is neither bvh nor flann");
}

Observed observed_kind(const char* name, const Json& value) {
  if (value == "none") return Observed::kNone;
  if (value == "auto") return Observed::kAuto;
  if (value == "sensor") return Observed::kSensor;
  refuse(name, value, "is none of none, auto, sensor");
}

const char* observed_name(Observed observed) {
  return observed == Observed::kAuto ? "auto" : observed == Observed::kSensor ? "sensor" : "none";
}

/// The registration methods, and what else moves the estimate.
std::vector<std::string> align_names() {
  std::vector<std::string> names = registration_names();
  names.insert(names.begin(), "none");
  for (const char* other : {"trajectory", "tanksandtemples"}) names.emplace_back(other);
  return names;
}

std::string one_of(const char* name, const Json& value, const std::vector<std::string>& known) {
  for (const std::string& word : known) {
    if (value == word) return word;
  }
  refuse(name, value, is_none_of(value.is_string() ? value.get<std::string>() : "", known).c_str());
}

bool flag(const char* name, const Json& value) {
  if (!value.is_boolean()) refuse(name, value, "is neither true nor false");
  return value.get<bool>();
}

Json optional_number(const std::optional<double>& v) { return v ? Json(*v) : Json(nullptr); }

/// null in a file leaves an optional option unset.
std::optional<double> positive_or_unset(const char* name, const Json& value) {
  if (value.is_null()) return std::nullopt;
  return positive(name, value);
}

Json crop_json(const EvaluationOptions& o) {
  if (!o.crop) return nullptr;
  return {o.crop->min.x(), o.crop->min.y(), o.crop->min.z(), o.crop->max.x(), o.crop->max.y(), o.crop->max.z()};
}

/// A number from all of the text.
double number_from_text(const OptionSpec& spec, const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw UsageError(fmt::format("{}: \"{}\" is not a number", spec.name, text));
  }
  return value;
}

/// The parts between commas, without the blanks around them.
std::vector<std::string> split(const std::string& text) {
  constexpr std::string_view kBlanks = " \t";
  std::vector<std::string> parts;
  if (text.find_first_not_of(kBlanks) == text.npos) return parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, comma - begin);
    const std::size_t first = part.find_first_not_of(kBlanks);
    parts.push_back(first == part.npos ? "" : part.substr(first, part.find_last_not_of(kBlanks) + 1 - first));
    begin = comma + 1;
  }
  return parts;
}

Json value_from_text(const OptionSpec& spec, const std::string& text) {
  switch (spec.kind) {
    case OptionKind::kNumber:
      return number_from_text(spec, text);
    case OptionKind::kCount: {
      const double v = number_from_text(spec, text);
      return v == std::floor(v) && std::abs(v) < 1e15 ? Json(static_cast<std::int64_t>(v)) : Json(v);
    }
    case OptionKind::kFlag:
      return text == "true" ? Json(true) : text == "false" ? Json(false) : Json(text);
    case OptionKind::kNumbers: {
      Json list = Json::array();
      for (const std::string& part : split(text)) list.push_back(number_from_text(spec, part));
      return list;
    }
    case OptionKind::kWords:
      return split(text);
    case OptionKind::kWord:
      return text;
  }
  return nullptr;
}

std::vector<std::string> names_of_options() {
  std::vector<std::string> names;
  for (const OptionSpec& spec : evaluation_option_specs()) names.emplace_back(spec.name);
  return names;
}

void apply(EvaluationOptions& options, const Json& config) {
  if (!config.is_object()) throw UsageError("expected a JSON object of options");
  for (const auto& [key, value] : config.items()) {
    const auto spec = std::ranges::find_if(evaluation_option_specs(), [&](const auto& s) { return key == s.name; });
    if (spec == evaluation_option_specs().end()) {
      throw UsageError(fmt::format("unknown key \"{}\"{}", key, did_you_mean(key, names_of_options())));
    }
    spec->set(options, value);
  }
}

}  // namespace

// One line for each option: name, kind, placeholder, help, setter, getter.
#define CMAP_OPTION(name, kind, placeholder, help, field, checked, json) \
  OptionSpec {                                                           \
    name, OptionKind::kind, placeholder, help,                           \
        [](EvaluationOptions& o, const Json& value) {                    \
          constexpr const char* n = name;                                \
          o.field = checked;                                             \
        },                                                               \
        [](const EvaluationOptions& o) -> Json { return json; }          \
  }

const std::vector<OptionSpec>& evaluation_option_specs() {
  static const std::vector<OptionSpec> specs{
      CMAP_OPTION("metrics", kWords, "LIST",
                  "groups (color, color+, geometry, distribution, mme, density, all), metric ids or symbols", metrics,
                  metric_list(n, value), o.metrics.empty() ? std::vector<std::string>{"default"} : o.metrics),
      CMAP_OPTION("thresholds", kNumbers, "METERS,...", "of accuracy, fitness, completeness, F-score", thresholds_m,
                  thresholds(n, value), o.thresholds_m),
      CMAP_OPTION("overlap-distance", kNumber, "METERS", "of overlap, truncated Chamfer and inlier RMSE",
                  overlap_distance_m, positive(n, value), o.overlap_distance_m),
      CMAP_OPTION("lcr-tau", kNumber, "TAU", "a color is right within 3 tau, unit RGB", lcr_tau, positive(n, value),
                  o.lcr_tau),
      CMAP_OPTION("lcr-radius", kNumber, "METERS", "within which LCR looks for the right color", lcr_radius_m,
                  positive(n, value), o.lcr_radius_m),
      CMAP_OPTION("lcr-curve", kFlag, "", "LCR for tau = 0.02 ... 0.30 and the area under the curve", lcr_curve,
                  flag(n, value), o.lcr_curve),
      CMAP_OPTION("ccs-voxel", kNumber, "METERS", "voxel of color consistency", ccs_voxel_m, positive(n, value),
                  o.ccs_voxel_m),
      CMAP_OPTION("ccs-singletons", kWord, "zero|exclude|refuse",
                  "a voxel of one point counts as 0, is left out, or ends the program", ccs_singletons,
                  singletons_kind(n, value), singletons_name(o.ccs_singletons)),
      CMAP_OPTION("ccs-min-points", kCount, "N", "points that such a voxel needs where others are left out",
                  ccs_min_points, count(n, value, 2, kMostPoints), o.ccs_min_points),
      CMAP_OPTION("awd-voxel", kNumber, "METERS", "voxel of the average Wasserstein distance", awd_voxel_m,
                  positive(n, value), o.awd_voxel_m),
      CMAP_OPTION("awd-min-points", kCount, "N", "points of each map that such a voxel needs", awd_min_points,
                  count(n, value, 2, kMostPoints), o.awd_min_points),
      CMAP_OPTION("scs-radius", kCount, "VOXELS", "neighborhood of spatial consistency", scs_radius_voxels,
                  count(n, value, 1, 1000), o.scs_radius_voxels),
      CMAP_OPTION("mme-radius", kNumber, "METERS", "neighborhood of mean map entropy", mme_radius_m, positive(n, value),
                  o.mme_radius_m),
      CMAP_OPTION("mme-min-neighbors", kCount, "N", "neighbors that a point needs", mme_min_neighbors,
                  count(n, value, 2, kMostPoints), o.mme_min_neighbors),
      CMAP_OPTION("color-max-distance", kNumber, "METERS", "leave farther pairs out of color distance",
                  color_max_distance_m, positive_or_unset(n, value), optional_number(o.color_max_distance_m)),
      CMAP_OPTION("voxel", kNumber, "METERS", "thin both maps first: mean position and color per voxel", voxel_m,
                  positive_or_unset(n, value), optional_number(o.voxel_m)),
      CMAP_OPTION("crop", kNumbers, "X0,Y0,Z0,X1,Y1,Z1", "keep this box of both maps, in the reference frame", crop,
                  value.is_null() ? std::nullopt : std::optional(crop_box(n, value)), crop_json(o)),
      CMAP_OPTION("as", kWords, "TOOLS",
                  "also what color-map-evaluation (the paper's authors'), cloudanalyzer, mapeval, open3d, mpeg, "
                  "cloudcompare or tanksandtemples would print",
                  as, tools(n, value), o.as),
      CMAP_OPTION("bootstrap", kCount, "N", "confidence intervals of 95 % from N replicates of blocks of the map",
                  bootstrap, count(n, value, 0, 1'000'000), o.bootstrap),
      CMAP_OPTION("block", kNumber, "METERS", "edge of those blocks", block_m, positive(n, value), o.block_m),
      CMAP_OPTION("observed", kWord, "none|auto|sensor",
                  "also the metrics without what the other map could not have seen: auto, nothing within 1 m columns; "
                  "sensor, the reference as --observed-from sees it",
                  observed, observed_kind(n, value), observed_name(o.observed)),
      CMAP_OPTION("observed-range", kNumber, "METERS", "how far that sensor sees", visibility.range_m,
                  positive(n, value), o.visibility.range_m),
      CMAP_OPTION("observed-voxel", kNumber, "METERS", "voxels of the reference that hide others from it",
                  visibility.voxel_m, positive(n, value), o.visibility.voxel_m),
      CMAP_OPTION("align", kWord, "METHOD",
                  "move the estimate first: none, a method of cmap_align, trajectory or tanksandtemples", align,
                  one_of(n, value, align_names()), o.align),
      CMAP_OPTION("align-voxel", kNumber, "METERS", "thinning for the alignment; by default from the reference's size",
                  align_voxel_m, positive_or_unset(n, value), optional_number(o.align_voxel_m)),
      CMAP_OPTION("align-distance", kNumber, "METERS", "farther pairs are no matches; by default 10 voxels",
                  align_distance_m, positive_or_unset(n, value), optional_number(o.align_distance_m)),
      CMAP_OPTION("align-scale", kFlag, "", "icp, plane, gicp, global: also find the scale (sim3 always does)",
                  align_scale, flag(n, value), o.align_scale),
      CMAP_OPTION("trajectory-fit", kWord, "FIT", "of trajectories: first-frame, se3 or sim3", trajectory_fit,
                  one_of(n, value, {"first-frame", "se3", "sim3"}), o.trajectory_fit),
      CMAP_OPTION("tanksandtemples-tau", kNumber, "METERS", "its threshold; by default the largest of the thresholds",
                  tanks_and_temples_tau_m, positive_or_unset(n, value), optional_number(o.tanks_and_temples_tau_m)),
      CMAP_OPTION("sensitivity", kFlag, "", "how far every metric goes when the alignment is a little off", sensitivity,
                  flag(n, value), o.sensitivity),
      CMAP_OPTION("sensitivity-translation", kNumber, "METERS", "that little, along every axis",
                  sensitivity_translation_m, positive(n, value), o.sensitivity_translation_m),
      CMAP_OPTION("sensitivity-rotation", kNumber, "DEGREES", "and about every axis", sensitivity_rotation_deg,
                  positive(n, value), o.sensitivity_rotation_deg),
      CMAP_OPTION("index", kWord, "bvh|flann", "nearest-neighbor index", index, index_kind(n, value),
                  o.index == IndexKind::kFlann ? "flann" : "bvh"),
      CMAP_OPTION("keep-noise", kFlag, "", "LAS: points of the noise classes 7 and 18 count too", keep_noise,
                  flag(n, value), o.keep_noise),
      CMAP_OPTION("classes", kNumbers, "N,...", "LAS: only points of these classes count (2 is ground)", classes,
                  classes(n, value), o.classes),
  };
  return specs;
}

#undef CMAP_OPTION

ReadOptions read_options(const EvaluationOptions& options, bool sha256) {
  return {.sha256 = sha256, .keep_noise = options.keep_noise, .classes = options.classes};
}

double tanks_and_temples_tau_m(const EvaluationOptions& options) {
  return options.tanks_and_temples_tau_m.value_or(std::ranges::max(options.thresholds_m));
}

std::string command_line_text(const Json& value) {
  if (value.is_null() || value.empty()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& item : value) text += fmt::format("{}{}", text.empty() ? "" : ",", command_line_text(item));
  return text;
}

void set_option(EvaluationOptions& options, const OptionSpec& spec, const std::string& text) {
  spec.set(options, value_from_text(spec, text));
}

void apply_config(EvaluationOptions& options, const std::string& json_text, const std::string& source) {
  read_json(json_text, source, [&](const Json& config) { apply(options, config); });
}

void apply_config_file(EvaluationOptions& options, const std::filesystem::path& path) {
  read_json_file(path, "a configuration file", [&](const Json& config) { apply(options, config); });
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.emplace_back(preset.name);
  return names;
}

void apply_preset(EvaluationOptions& options, const std::string& name) {
  for (const Preset& preset : presets()) {
    if (preset.name == name) return apply_config(options, std::string(preset.json), "preset " + name);
  }
  throw UsageError(fmt::format("preset: \"{}\" is unknown{}; presets are {}", name, did_you_mean(name, preset_names()),
                               fmt::join(preset_names(), ", ")));
}

Json to_json(const EvaluationOptions& options) {
  Json json;
  for (const OptionSpec& spec : evaluation_option_specs()) json[spec.name] = spec.get(options);
  return json;
}

}  // namespace cmap
