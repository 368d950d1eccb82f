#include "clouds/point_names.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace cmap {
namespace {

using namespace std::string_view_literals;
using Triple = std::array<std::string_view, 3>;

constexpr Triple kAxes[] = {
    {"x", "y", "z"},
    {"posx", "posy", "posz"},
    {"positionx", "positiony", "positionz"},
    {"pointx", "pointy", "pointz"},
    {"coordx", "coordy", "coordz"},
    {"coordinatex", "coordinatey", "coordinatez"},
    {"px", "py", "pz"},
    {"xpos", "ypos", "zpos"},
    {"xposition", "yposition", "zposition"},
    {"xcoord", "ycoord", "zcoord"},
    {"xcoordinate", "ycoordinate", "zcoordinate"},
    {"worldx", "worldy", "worldz"},
    {"globalx", "globaly", "globalz"},
    {"easting", "northing", "height"},
    {"easting", "northing", "elevation"},
    {"easting", "northing", "altitude"},
    {"easting", "northing", "elev"},
    {"easting", "northing", "alt"},
    {"easting", "northing", "z"},
    {"easting", "northing", "up"},
    {"east", "north", "up"},
    {"east", "north", "height"},
    {"east", "north", "elevation"},
    {"east", "north", "z"},
    {"e", "n", "u"},
    {"e", "n", "h"},
    {"e", "n", "z"},
    {"x", "y", "height"},
    {"x", "y", "elevation"},
    {"x", "y", "altitude"},
    {"x", "y", "h"},
};

constexpr Triple kColors[] = {
    {"red", "green", "blue"},
    {"diffusered", "diffusegreen", "diffuseblue"},
    {"r", "g", "b"},
    {"rf", "gf", "bf"},
    {"colorr", "colorg", "colorb"},
    {"colourr", "colourg", "colourb"},
    {"colorred", "colorgreen", "colorblue"},
    {"colourred", "colourgreen", "colourblue"},
    {"rgbr", "rgbg", "rgbb"},
    {"rcolor", "gcolor", "bcolor"},
    {"redcolor", "greencolor", "bluecolor"},
    {"vertexred", "vertexgreen", "vertexblue"},
    {"red8", "green8", "blue8"},
    {"red16", "green16", "blue16"},
    {"r8", "g8", "b8"},
    {"r16", "g16", "b16"},
    {"scalarr", "scalarg", "scalarb"},
    {"scalarred", "scalargreen", "scalarblue"},
};

constexpr std::string_view kPacked[] = {"rgb", "rgba"};

/// Units that follow the name of an axis; what is empty is meters.
struct UnitSuffix {
  std::string_view suffix, unit;
};
constexpr UnitSuffix kUnitSuffixes[] = {
    {"m", ""},    {"meter", ""},  {"meters", ""},   {"metre", ""},    {"metres", ""},   {"mm", "mm"},      {"cm", "cm"},
    {"km", "km"}, {"ft", "feet"}, {"feet", "feet"}, {"usft", "feet"}, {"in", "inches"}, {"inch", "inches"}};

std::optional<ColumnTriple> find_triple(std::span<const std::string> plain, const Triple& wanted, auto&& same) {
  ColumnTriple places{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found =
        std::find_if(plain.begin(), plain.end(), [&](const auto& name) { return same(name, wanted[k]); });
    if (found == plain.end()) return std::nullopt;
    places[k] = static_cast<std::size_t>(found - plain.begin());
  }
  return places;
}

bool equal(std::string_view name, std::string_view wanted) { return name == wanted; }

bool equal_but_for_unit(std::string_view name, std::string_view wanted) {
  if (!name.starts_with(wanted)) return false;
  const std::string_view rest = name.substr(wanted.size());
  return rest.empty() || std::any_of(std::begin(kUnitSuffixes), std::end(kUnitSuffixes),
                                     [&](const UnitSuffix& unit) { return unit.suffix == rest; });
}

std::optional<ColumnTriple> find_position(std::span<const std::string> plain) {
  for (const Triple& axes : kAxes) {
    if (const auto found = find_triple(plain, axes, equal)) return found;
  }
  for (const Triple& axes : kAxes) {
    if (const auto found = find_triple(plain, axes, equal_but_for_unit)) return found;
  }
  return std::nullopt;
}

std::vector<std::string> plain_names(std::span<const std::string> names) {
  std::vector<std::string> plain;
  for (const std::string& name : names) plain.push_back(plain_name(name));
  return plain;
}

}  // namespace

std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte)) plain += static_cast<char>(std::tolower(byte));
  }
  return plain;
}

PointNames find_point_names(std::span<const std::string> names) {
  const std::vector<std::string> plain = plain_names(names);
  PointNames found;
  found.position = find_position(plain);
  for (const Triple& channels : kColors) {
    if (found.color) break;
    found.color = find_triple(plain, channels, equal);
    const auto is_there = [&](std::string_view name) {
      return std::find(plain.begin(), plain.end(), name) != plain.end();
    };
    const auto n = static_cast<std::size_t>(std::count_if(channels.begin(), channels.end(), is_there));
    found.n_color_channels = std::max(found.n_color_channels, n);
  }
  for (const std::string_view name : kPacked) {
    const auto place = std::find(plain.begin(), plain.end(), name);
    if (place != plain.end() && !found.packed_color)
      found.packed_color = static_cast<std::size_t>(place - plain.begin());
  }
  return found;
}

bool names_splats(std::span<const std::string> names) {
  return std::any_of(names.begin(), names.end(), [](const auto& name) {
    const std::string plain = plain_name(name);
    return plain == "fdc0" || plain == "packedposition";
  });
}

bool names_degrees(std::span<const std::string> names) {
  const std::vector<std::string> plain = plain_names(names);
  const auto any_starts_with = [&](std::initializer_list<std::string_view> starts) {
    return std::any_of(plain.begin(), plain.end(), [&](const std::string& name) {
      return std::any_of(starts.begin(), starts.end(), [&](std::string_view start) {
        return name == start || (start.size() > 3 && name.starts_with(start));
      });
    });
  };
  return any_starts_with({"lat", "latitude"}) && any_starts_with({"lon", "lng", "longitude"});
}

std::string_view unit_in_name(std::string_view name) {
  const std::string plain = plain_name(name);
  for (const Triple& axes : kAxes) {
    for (const std::string_view axis : axes) {
      if (!std::string_view(plain).starts_with(axis)) continue;
      for (const UnitSuffix& unit : kUnitSuffixes) {
        if (std::string_view(plain).substr(axis.size()) == unit.suffix) return unit.unit;
      }
    }
  }
  return {};
}

}  // namespace cmap
