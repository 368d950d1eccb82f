#include <fmt/format.h>

#include <cstdint>
#include <map>

#include "bytes/little_endian.hpp"
#include "units/coordinate_units.hpp"
#include "units/epsg_units.hpp"

namespace cmap {
namespace {

// Keys of the GeoTIFF specification.
constexpr int kModelType = 1024;
constexpr int kGeographicSystem = 2048;
constexpr int kGeographicLengthUnit = 2052;  // of a geocentric system
constexpr int kProjectedSystem = 3072;
constexpr int kProjectedUnit = 3076;
constexpr int kProjectedUnitSize = 3077;
constexpr int kVerticalSystem = 4096;
constexpr int kVerticalUnit = 4099;

constexpr int kGeographicModel = 2;
constexpr int kGeocentricModel = 3;
constexpr int kUserDefined = 32767;
constexpr int kDoubleParameters = 34736;
// Vertical systems of GeoTIFF 1.0 that name a surface and no unit.
constexpr int kFirstOldVertical = 5001, kLastOldVertical = 5106;

class Keys {
 public:
  Keys(std::span<const std::byte> directory, std::span<const std::byte> doubles) {
    constexpr std::size_t kKeyEntryBytes = 8;
    has_header_ = directory.size() >= kKeyEntryBytes;
    if (!has_header_) return;
    n_said_ = load_little<std::uint16_t>(directory, 6);
    for (std::size_t i = 1; i <= n_said_ && (i + 1) * kKeyEntryBytes <= directory.size(); ++i) {
      const auto number = [&](std::size_t k) {
        return load_little<std::uint16_t>(directory, i * kKeyEntryBytes + 2 * k);
      };
      ++n_read_;
      if (number(1) == 0) values_[number(0)] = number(3);
      if (number(1) == kDoubleParameters && (number(3) + std::size_t{1}) * sizeof(double) <= doubles.size()) {
        doubles_[number(0)] = load_little<double>(doubles, number(3) * sizeof(double));
      }
    }
  }

  bool whole() const { return has_header_ && n_read_ == n_said_; }
  bool has(int key) const { return values_.contains(key); }
  /// 0 for none.
  int value(int key) const { return has(key) ? values_.at(key) : 0; }
  std::optional<double> size(int key) const {
    const auto found = doubles_.find(key);
    return found == doubles_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::map<int, int> values_;
  std::map<int, double> doubles_;
  std::size_t n_said_ = 0, n_read_ = 0;
  bool has_header_ = false;
};

bool is_geographic(const Keys& keys) {
  const int model = keys.value(kModelType);
  if (model > 0 && model != kUserDefined) return model == kGeographicModel;
  return keys.has(kGeographicSystem) && !keys.has(kProjectedSystem) && !keys.has(kProjectedUnit);
}

/// The unit that a key names by its code; sets `problem` where nobody knows it.
std::optional<double> named_unit_m(int code, CoordinateUnits& units) {
  const std::optional<double> unit_m = epsg_length_m(code);
  if (!unit_m) units.problem = fmt::format("a unit of length of the unknown code {}", code);
  return unit_m;
}

std::optional<double> projected_unit_m(const Keys& keys, CoordinateUnits& units) {
  const int unit = keys.value(kProjectedUnit), system = keys.value(kProjectedSystem);
  if (unit > 0 && unit != kUserDefined) return named_unit_m(unit, units);
  if (const auto size = keys.size(kProjectedUnitSize); unit == kUserDefined && size) return exact_unit_m(*size);
  if (system > 0 && system != kUserDefined) return epsg_projected_unit_m(system);
  return std::nullopt;
}

std::optional<double> vertical_unit_m(const Keys& keys, CoordinateUnits& units) {
  const int unit = keys.value(kVerticalUnit), system = keys.value(kVerticalSystem);
  if (unit > 0 && unit != kUserDefined) return named_unit_m(unit, units);
  if (system == 0 || system == kUserDefined) return std::nullopt;
  if (system >= kFirstOldVertical && system <= kLastOldVertical) return std::nullopt;
  return epsg_vertical_unit_m(system);
}

}  // namespace

CoordinateUnits units_from_geo_keys(std::span<const std::byte> directory, std::span<const std::byte> doubles) {
  const Keys keys(directory, doubles);
  CoordinateUnits units;
  if (!keys.whole()) units.problem = "a list of GeoKeys that ends too early";
  const bool geographic = is_geographic(keys), geocentric = keys.value(kModelType) == kGeocentricModel;
  const int system = keys.value(geographic || geocentric ? kGeographicSystem : kProjectedSystem);
  if (system > 0 && system != kUserDefined) units.system = fmt::format("EPSG:{}", system);
  units.angular = geographic;
  if (geographic) return units;
  if (geocentric) {
    units.horizontal_m = keys.has(kGeographicLengthUnit) ? named_unit_m(keys.value(kGeographicLengthUnit), units) : 1.0;
    units.vertical_m = units.horizontal_m;
    return units;
  }
  units.horizontal_m = projected_unit_m(keys, units);
  units.vertical_m = vertical_unit_m(keys, units);
  return units;
}

}  // namespace cmap
