#include "cmap/io/shift_hint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cmap/core/spelling.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeadBytes = std::size_t{1} << 16;

/// The first bytes of a regular file; empty for anything else.
std::string head_of(const fs::path& path) {
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return {};
  std::ifstream file(path, std::ios::binary);
  std::string head(kHeadBytes, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

std::string_view next_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
  text.remove_prefix(std::min(line.size() + 1, text.size()));
  return line;
}

/// The finite numbers of a text, whatever stands between them.
std::vector<double> numbers_of(std::string_view text) {
  constexpr std::string_view kBetween = " \t,;:=()[]";
  std::vector<double> numbers;
  while (!text.empty()) {
    const std::string_view token = text.substr(0, text.find_first_of(kBetween));
    text.remove_prefix(std::min(token.size() + 1, text.size()));
    double value = 0.0;
    if (!token.empty() && parse_number(token, value) && std::isfinite(value)) numbers.push_back(value);
  }
  return numbers;
}

/// What a comment says; nothing if the line is none.
std::optional<std::string_view> comment_of(std::string_view line) {
  for (const std::string_view mark : {"comment ", "obj_info ", "#", "//"}) {
    if (line.starts_with(mark)) return line.substr(mark.size());
  }
  return std::nullopt;
}

void add_comments(const fs::path& map, std::vector<ShiftHint>& hints) {
  const std::string head = head_of(map);
  for (std::string_view rest = head; !rest.empty();) {
    const std::string_view line = next_line(rest);
    if (line.starts_with("end_header") || line.starts_with("DATA")) break;
    const std::optional<std::string_view> comment = comment_of(line);
    if (!comment) continue;
    const std::string lower = lower_case(*comment);
    const std::size_t word = std::min(lower.find("offset"), lower.find("shift"));
    if (word == std::string::npos) continue;
    const std::vector<double> shift = numbers_of(comment->substr(word));
    if (shift.size() != 3) continue;
    const std::size_t text = std::min(comment->find_first_not_of(' '), comment->size());
    hints.push_back({{shift[0], shift[1], shift[2]},
                     fmt::format("the comment '{}' of {}", comment->substr(text), map.filename().string())});
  }
}

/// Pix4D: east, north and height in one line, under the name of the project with which its maps' names begin.
void add_pix4d(const fs::path& map, std::vector<ShiftHint>& hints) {
  constexpr std::string_view kEnd = "_offset.xyz";
  const std::string stem = map.stem().string();
  std::error_code none;
  for (const fs::directory_entry& beside : fs::directory_iterator(map.parent_path() / ".", none)) {
    const std::string name = beside.path().filename().string();
    if (!name.ends_with(kEnd) || !stem.starts_with(name.substr(0, name.size() - kEnd.size()))) continue;
    const std::string head = head_of(beside.path());
    std::string_view rest = head;
    const std::vector<double> shift = numbers_of(next_line(rest));
    if (shift.size() == 3) hints.push_back({{shift[0], shift[1], shift[2]}, name});
  }
}

/// OpenDroneMap: a line that names the UTM zone, then east and north; heights are absolute.
void add_open_drone_map(const fs::path& file, std::vector<ShiftHint>& hints) {
  const std::string head = head_of(file);
  std::string_view rest = head;
  if (lower_case(next_line(rest)).find("utm") == std::string::npos) return;
  if (rest.starts_with('\n')) rest.remove_prefix(1);
  const std::vector<double> shift = numbers_of(next_line(rest));
  if (shift.size() == 2 || shift.size() == 3) {
    hints.push_back({{shift[0], shift[1], shift.size() == 3 ? shift[2] : 0.0}, file.filename().string()});
  }
}

void add_opensfm(const fs::path& file, std::vector<ShiftHint>& hints) {
  const auto json = nlohmann::json::parse(head_of(file), nullptr, false);
  if (!json.is_object()) return;
  std::array<double, 3> lla{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = json.find(std::array{"latitude", "longitude", "altitude"}[i]);
    if (value == json.end() || !value->is_number()) return;
    lla[i] = value->get<double>();
  }
  if (!(std::abs(lla[0]) <= 84.0 && std::abs(lla[1]) <= 180.0)) return;
  const Eigen::Vector2d utm = utm_of(lla[0], lla[1]);
  hints.push_back({{utm.x(), utm.y(), lla[2]}, file.filename().string(), true});
}

}  // namespace

std::vector<ShiftHint> find_shift_hints(const fs::path& map) {
  std::vector<ShiftHint> hints;
  std::error_code none;
  const fs::path absolute = fs::absolute(map, none);
  if (none || !fs::is_regular_file(absolute, none)) return hints;
  add_comments(absolute, hints);
  add_pix4d(absolute, hints);
  const fs::path folder = absolute.parent_path(), above = folder.parent_path();
  for (const fs::path& place : {folder, above / "odm_georeferencing"}) {
    add_open_drone_map(place / "coords.txt", hints);
    add_open_drone_map(place / "odm_georeferencing_model_geo.txt", hints);
  }
  // OpenSfM's maps are up to two folders below it.
  for (const fs::path& place : {folder, above, above.parent_path()}) add_opensfm(place / "reference_lla.json", hints);
  return hints;
}

}  // namespace cmap
