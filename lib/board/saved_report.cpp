#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cmap/board/comparison.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/json_text.hpp"
#include "cmap/report/report.hpp"
#include "earlier_reports.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;
using Type = Json::value_t;
namespace fs = std::filesystem;

/// A value of a report and where it stands, so that a damaged file is refused with its place.
class Place {
 public:
  Place(const Json& value, std::string source, std::string path = "")
      : value_(value), source_(std::move(source)), path_(std::move(path)) {}

  Place operator[](const std::string& key) const {
    require(value_.is_object(), "an object");
    const auto found = value_.find(key);
    if (found == value_.end()) fail(fmt::format("has no \"{}\"", key));
    return {*found, source_, path_.empty() ? key : path_ + "." + key};
  }
  std::vector<std::pair<std::string, Place>> members() const {
    require(value_.is_object(), "an object");
    std::vector<std::pair<std::string, Place>> list;
    for (const auto& [key, value] : value_.items()) list.emplace_back(key, (*this)[key]);
    return list;
  }
  std::vector<Place> entries() const {
    require(value_.is_array() && !value_.empty(), "a list");
    std::vector<Place> list;
    for (std::size_t i = 0; i < value_.size(); ++i) {
      list.emplace_back(value_[i], source_, fmt::format("{}[{}]", path_, i));
    }
    return list;
  }
  bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }
  void be_null() const { require(value_.is_null(), "null"); }
  void be_object() const { require(value_.is_object(), "an object"); }
  void be_text() const { require(value_.is_string(), "text"); }
  void be_number() const { require(value_.is_number(), "a number"); }
  void be_count() const { require(value_.is_number_unsigned(), "a count"); }
  void be_number_or_null() const { require(value_.is_number() || value_.is_null(), "a number or null"); }
  void be_text_or_null() const { require(value_.is_string() || value_.is_null(), "text or null"); }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(fmt::format("{}: damaged report: {} {}", source_, path_.empty() ? "it" : path_, reason));
  }
  void require(bool holds, const char* expected) const {
    if (!holds) fail(fmt::format("is {}, expected {}", value_.type_name(), expected));
  }

  const Json& value_;
  std::string source_, path_;
};

void check_levels(const Place& record) {
  for (const char* level : {"floor", "chance", "skill"}) {
    if (record.has(level)) record[level]["value"].be_number_or_null();
  }
  if (record.has("skill") && record["skill"].has("reason")) record["skill"]["reason"].be_text();
}

void check_phases(const Place& phases) {
  phases["n"].be_count();
  for (const char* number : {"mean", "std", "min", "max"}) phases[number].be_number_or_null();
  for (const Place& value : phases["values"].entries()) value.be_number_or_null();
}

void check_record(const Place& record) {
  record["unit"].be_text();
  record["symbol"].be_text();
  record["better"].be_text_or_null();
  record["parameters"].be_object();
  if (record.has("coverage")) record["coverage"].be_number_or_null();
  check_levels(record);
  if (record.has("phases")) check_phases(record["phases"]);
  if (record.has("per_threshold")) {
    for (const Place& entry : record["per_threshold"].entries()) {
      entry["threshold_m"].be_number();
      entry["value"].be_number_or_null();
      check_levels(entry);
    }
  } else if (record.has("per_range")) {
    for (const Place& bin : record["per_range"].entries()) {
      bin["lo_m"].be_number();
      bin["hi_m"].be_number();
      bin["value"].be_number_or_null();
    }
  } else {
    record["value"].be_number_or_null();
  }
}

void check_input(const Place& input) {
  for (const char* text : {"path", "sha256"}) input[text].be_text();
  input["finite_points"].be_count();
}

void check_curve(const Place& curve) {
  for (const char* axis : {"tau", "value"}) {
    for (const Place& number : curve[axis].entries()) number.be_number();
  }
  if (!curve.has("chance")) return;
  for (const Place& number : curve["chance"].entries()) number.be_number_or_null();
}

/// The last `n` parts of a path, without the extension of the file.
std::string end_of(const fs::path& path, std::size_t n) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  std::vector<fs::path> parts(whole.begin(), whole.end());
  fs::path end = whole.stem();
  for (std::size_t i = 1; i < n && i < parts.size(); ++i) end = parts[parts.size() - 1 - i] / end;
  return end.string();
}

void require_distinct(const std::vector<SavedReport>& reports) {
  std::set<std::string> seen;
  for (const SavedReport& report : reports) {
    if (report.name.empty()) throw UsageError(fmt::format("{}: its name is empty", report.path));
    if (!seen.insert(report.name).second) throw UsageError(fmt::format("names: \"{}\" is given twice", report.name));
  }
}

}  // namespace

void check_report(const Json& report, const std::string& source) {
  const Place top(report, source);
  if (!top.has("schema") || !is_known_schema(report.at("schema"))) {
    throw UsageError(fmt::format("{}: is no report of cmap_eval: its schema is {}, expected \"{}\" or an earlier one",
                                 source, top.has("schema") ? report.at("schema").dump() : "missing", kReportSchema));
  }
  top["tool"]["version"].be_text();
  top["parameters"].be_object();
  check_input(top["inputs"]["estimate"]);
  if (top["inputs"].has("reference")) {
    check_input(top["inputs"]["reference"]);
    top["alignment"]["method"].be_text();
  } else {
    top["alignment"].be_null();
  }
  for (const auto& [id, record] : top["metrics"].members()) {
    check_record(record);
    if (record.has("curve")) check_curve(record["curve"]);
  }
  if (top.has("intervals")) {
    const Place intervals = top["intervals"];
    for (const char* count : {"replicates", "seed"}) intervals[count].be_count();
    intervals["level"].be_number();
    intervals["blocks"].be_object();
  }
}

SavedReport read_report(const fs::path& path) {
  SavedReport report{name_of_input(path), "", nullptr};
  try {
    read_json_file(path, "a report", [&](const Json& json) { report.json = json; });
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
  check_report(report.json, report.path);
  complete_earlier_report(report.json);
  return report;
}

void name_reports(std::vector<SavedReport>& reports, const std::vector<std::string>& names) {
  if (!names.empty()) {
    if (names.size() != reports.size()) {
      throw UsageError(fmt::format("names: {} for {} reports", names.size(), reports.size()));
    }
    for (std::size_t i = 0; i < names.size(); ++i) reports[i].name = names[i];
    return require_distinct(reports);
  }
  std::set<fs::path> files;
  for (const SavedReport& report : reports) {
    if (!files.insert(place_of_file(report.path)).second) {
      throw UsageError(fmt::format("{}: is given twice", report.path));
    }
  }
  constexpr std::size_t kDeepest = 64;
  for (std::size_t n = 1; n <= kDeepest; ++n) {
    std::set<std::string> ends;
    for (SavedReport& report : reports) ends.insert(report.name = end_of(report.path, n));
    if (ends.size() == reports.size()) return;
  }
  for (SavedReport& report : reports) report.name = report.path;
  require_distinct(reports);
}

}  // namespace cmap
