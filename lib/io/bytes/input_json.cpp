#include "bytes/input_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

template <class Read>
void as_input(Read&& read) {
  try {
    read();
  } catch (const UsageError& error) {
    throw InputError(error.what());
  }
}

std::string full_name(std::string_view where, std::string_view key) {
  return where.empty() ? std::string(key) : fmt::format("{}.{}", where, key);
}

}  // namespace

void read_input_json(const std::string& text, const std::string& source, const JsonReader& read) {
  as_input([&] { read_json(text, source, read); });
}

void read_parsed_input_json(const Json& parsed, const std::string& source, const JsonReader& read) {
  as_input([&] { read_parsed_json(parsed, source, read); });
}

void read_input_json_file(const std::filesystem::path& path, const std::string& kind, const JsonReader& read) {
  if (!is_there(path)) throw InputError(fmt::format("{}: no such file; {} expected", path.string(), kind));
  as_input([&] { read_json_file(path, kind, read); });
}

void check_keys(const Json& json, std::string_view where, std::initializer_list<std::string_view> required,
                std::initializer_list<std::string_view> optional) {
  if (!json.is_object()) throw UsageError(fmt::format("{}: an object expected", where.empty() ? "the file" : where));
  const auto among = [](const auto& names, std::string_view key) {
    return std::find(names.begin(), names.end(), key) != names.end();
  };
  std::vector<std::string> wrong;
  for (const auto& [key, value] : json.items()) {
    if (!among(required, key) && !among(optional, key)) {
      wrong.push_back(fmt::format("unknown key \"{}\"", full_name(where, key)));
    }
  }
  for (const std::string_view key : required) {
    if (!json.contains(key)) wrong.push_back(fmt::format("key \"{}\" is missing", full_name(where, key)));
  }
  if (!wrong.empty()) throw UsageError(fmt::format("{}", fmt::join(wrong, "; ")));
}

double finite_number(const Json& json, std::string_view name) {
  if (!json.is_number() || !std::isfinite(json.get<double>())) {
    throw UsageError(fmt::format("{}: {} is no finite number", name, json.dump()));
  }
  return json.get<double>();
}

int whole_number(const Json& json, std::string_view name) {
  const bool whole = json.is_number_integer() && json.get<std::int64_t>() >= 0 &&
                     (!json.is_number_unsigned() || json.get<std::uint64_t>() <= std::numeric_limits<int>::max()) &&
                     json.get<std::int64_t>() <= std::numeric_limits<int>::max();
  if (!whole) throw UsageError(fmt::format("{}: {} is no whole number", name, json.dump()));
  return json.get<int>();
}

}  // namespace cmap
