#include "cmap/io/json_text.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

/// Refuses a key that an object has twice; the parser alone would keep the last.
class RepetitionCheck {
 public:
  bool operator()(int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys_.emplace_back();
    if (event == Json::parse_event_t::object_end) keys_.pop_back();
    if (event == Json::parse_event_t::key && !keys_.back().insert(parsed.get<std::string>()).second) {
      throw UsageError(fmt::format("key \"{}\" is given twice", parsed.get<std::string>()));
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> keys_;  ///< of the objects around the place
};

/// Whatever is wrong with the JSON of a source names it.
template <class Read>
void name_source(const std::string& source, Read&& read) {
  try {
    read();
  } catch (const Json::exception& error) {
    const std::string_view message = error.what();  // "[json.exception...] parse error at line 1, column 2: ..."
    throw UsageError(fmt::format("{}: {}", source, message.substr(message.find(']') + 2)));
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", source, error.what()));
  }
}

}  // namespace

void read_json(const std::string& text, const std::string& source, const JsonReader& read) {
  name_source(source, [&] { read(Json::parse(text, RepetitionCheck(), true, /*ignore_comments=*/true)); });
}

void read_parsed_json(const Json& parsed, const std::string& source, const JsonReader& read) {
  name_source(source, [&] { read(parsed); });
}

void read_json_file(const std::filesystem::path& path, const std::string& kind, const JsonReader& read) {
  const std::filesystem::path place = path == kStandardStream ? "/dev/stdin" : path;
  std::ifstream file(place, std::ios::binary);
  if (!file || is_folder(place)) {
    throw UsageError(fmt::format("{}: cannot be read as {}", name_of_input(path), kind));
  }
  read_json(std::string{std::istreambuf_iterator<char>(file), {}}, name_of_input(path), read);
}

}  // namespace cmap
