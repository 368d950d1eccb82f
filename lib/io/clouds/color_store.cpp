#include "clouds/color_store.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "clouds/color_plausibility.hpp"

namespace cmap {
namespace {

constexpr float kEightBitWhite = 255.0F, kSixteenBitWhite = 65535.0F;
// An overexposed picture in [0,1] reaches farther beyond than kColorOvershoot.
constexpr float kOvershootOfOne = 1.5F;
constexpr float kUndershoot = -0.06F;
// Below, leaving the range is rounding and not worth a word.
constexpr float kRounding = 1e-3F;

float white_for(float highest) {
  if (highest <= kOvershootOfOne) return 1.0F;
  return highest <= kColorOvershoot * kEightBitWhite ? kEightBitWhite : kSixteenBitWhite;
}

/// What a piece of floats holds, NaN aside.
struct FloatRange {
  float low = 0.0F, high = 0.0F;
  bool whole = true, finite = true;
};

FloatRange measure(const float* values, std::size_t n) {
  // Adding and subtracting 1.5 * 2^23 rounds to a whole number, for anything a color can be, in four lanes at a time.
  constexpr float kRound = 12582912.0F;
  constexpr std::size_t kLanes = 16;
  float low[kLanes] = {}, high[kLanes] = {}, fraction[kLanes] = {}, not_finite[kLanes] = {};
  const auto add = [&](std::size_t lane, float v) {
    low[lane] = v < low[lane] ? v : low[lane];
    high[lane] = v > high[lane] ? v : high[lane];
    fraction[lane] = std::max(fraction[lane], std::abs(v - ((v + kRound) - kRound)));
    not_finite[lane] += v * 0.0F;
  };
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) add(lane, values[i + lane]);
  }
  for (; i < n; ++i) add(i % kLanes, values[i]);
  FloatRange range;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    range.low = std::min(range.low, low[lane]);
    range.high = std::max(range.high, high[lane]);
    range.whole = range.whole && fraction[lane] == 0.0F;
    range.finite = range.finite && not_finite[lane] == 0.0F;
  }
  return range;
}

/// Moves the kept triples to the front; returns how many there are.
template <class Channel>
std::size_t compact(Channel* rgb, std::size_t n, const std::vector<std::uint32_t>* kept) {
  if (kept == nullptr) return n;
  for (std::size_t out = 0; out < kept->size(); ++out) std::copy_n(rgb + 3 * (*kept)[out], 3, rgb + 3 * out);
  return kept->size();
}

/// A point with a channel that is not finite has no color at all; returns how many there are.
std::uint64_t spread_nan(float* rgb, std::size_t n) {
  std::uint64_t n_without = 0;
  for (float* color = rgb; color != rgb + 3 * n; color += 3) {
    if (std::isfinite(color[0]) && std::isfinite(color[1]) && std::isfinite(color[2])) continue;
    std::fill_n(color, 3, std::numeric_limits<float>::quiet_NaN());
    ++n_without;
  }
  return n_without;
}

template <class Channel, class Out>
void convert(const Channel* from, std::size_t n, Out* to) {
  for (std::size_t i = 0; i < n; ++i) to[i] = static_cast<Out>(from[i]);
}

/// The first values of all colors, one after the other.
template <class Color>
auto* channels(Array<Color>& colors) {
  return colors.data()->data();
}

bool all_of_type(const PointColumns& columns, ScalarType type) {
  return std::all_of(columns.rgb.begin(), columns.rgb.end(), [&](const Column& c) { return c.type == type; });
}

}  // namespace

ColorStore::ColorStore(ColorDeclaration declaration, std::uint64_t max_points)
    : declaration_(std::move(declaration)), max_points_(max_points) {
  if (declaration_.storage != ColorStorage::kNone) colors_ = Array<Rgb8>(max_points);
}

void ColorStore::append(const ByteSource& source, const PointColumns& columns, std::size_t first, std::size_t n,
                        const std::vector<std::uint32_t>* kept, std::uint64_t point) {
  if (columns.color == ColorStorage::kNone) return;
  if (columns.color == ColorStorage::kPacked || all_of_type(columns, ScalarType::kUint8)) {
    append_bytes(columns, first, n, kept);
  } else if (all_of_type(columns, ScalarType::kUint16)) {
    append_shorts(columns, first, n, kept);
  } else {
    append_floats(source, columns, first, n, kept, point);
  }
}

void ColorStore::append_bytes(const PointColumns& columns, std::size_t first, std::size_t n,
                              const std::vector<std::uint32_t>* kept) {
  if (columns.color == ColorStorage::kPacked && columns.rgb[0].type == ScalarType::kFloat32) {
    std::array<float, kPiece> values;
    decode_packed(columns, first, n, values.data());
    for (std::size_t i = 0; i < n; ++i) packed_.add(values[i]);
  }
  std::uint8_t* out = channels(std::get<Array<Rgb8>>(colors_)) + 3 * size_;
  decode_colors(columns, first, n, out);
  n = compact(out, n, kept);
  std::uint8_t highest = 0;
  for (std::size_t i = 0; i < 3 * n; ++i) highest = std::max(highest, out[i]);
  highest_ = std::max(highest_, static_cast<float>(highest));
  size_ += n;
}

void ColorStore::append_shorts(const PointColumns& columns, std::size_t first, std::size_t n,
                               const std::vector<std::uint32_t>* kept) {
  std::array<std::uint16_t, 3 * kPiece> rgb;
  decode_colors(columns, first, n, rgb.data());
  n = compact(rgb.data(), n, kept);
  std::uint16_t highest = 0, bits = 0;
  for (std::size_t i = 0; i < 3 * n; ++i) {
    highest = std::max(highest, rgb[i]);
    bits = static_cast<std::uint16_t>(bits | rgb[i]);
  }
  highest_ = std::max(highest_, static_cast<float>(highest));
  bits_ |= bits;
  if (highest > kEightBitWhite) widen_to_shorts();
  if (auto* bytes = std::get_if<Array<Rgb8>>(&colors_)) {
    convert(rgb.data(), 3 * n, channels(*bytes) + 3 * size_);
  } else {
    convert(rgb.data(), 3 * n, channels(std::get<Array<Rgb16>>(colors_)) + 3 * size_);
  }
  size_ += n;
}

void ColorStore::append_floats(const ByteSource& source, const PointColumns& columns, std::size_t first, std::size_t n,
                               const std::vector<std::uint32_t>* kept, std::uint64_t point) {
  std::array<float, 3 * kPiece> rgb;
  decode_colors(columns, first, n, rgb.data());
  n = compact(rgb.data(), n, kept);
  FloatRange range = measure(rgb.data(), 3 * n);
  if (!range.finite) {
    n_without_color_ += spread_nan(rgb.data(), n);
    // Infinities have become NaN, which no comparison below sees.
    range = measure(rgb.data(), 3 * n);
    range.whole = false;
  }
  const auto place_of = [&](float value) {
    const auto place = static_cast<std::size_t>(std::find(rgb.begin(), rgb.end(), value) - rgb.begin());
    return std::pair{point + (kept == nullptr ? place / 3 : (*kept)[place / 3]), place % 3};
  };
  if (range.high > kColorOvershoot * kSixteenBitWhite) {
    const auto [at, channel] = place_of(range.high);
    source.fail("point {}: {} = {:g}; colors lie in 0 to 1, 0 to 255 or 0 to 65535", at + 1,
                declaration_.names[channel], range.high);
  }
  if (range.low < lowest_) {
    lowest_ = range.low;
    std::tie(lowest_point_, lowest_channel_) = place_of(range.low);
  }
  highest_ = std::max(highest_, range.high);
  store_floats(rgb.data(), n, range.whole && range.low >= 0.0F && range.high <= kSixteenBitWhite);
}

void ColorStore::store_floats(const float* rgb, std::size_t n, bool whole) {
  if (whole && highest_ > kEightBitWhite && std::holds_alternative<Array<Rgb8>>(colors_)) widen_to_shorts();
  if (!whole && !std::holds_alternative<Array<RgbF>>(colors_)) widen_to_floats();
  if (auto* bytes = std::get_if<Array<Rgb8>>(&colors_)) {
    convert(rgb, 3 * n, channels(*bytes) + 3 * size_);
  } else if (auto* shorts = std::get_if<Array<Rgb16>>(&colors_)) {
    std::uint16_t* out = channels(*shorts) + 3 * size_;
    convert(rgb, 3 * n, out);
    for (std::size_t i = 0; i < 3 * n; ++i) bits_ |= out[i];
  } else {
    if (white_for(highest_) != white_) set_white(white_for(highest_));
    float* out = channels(std::get<Array<RgbF>>(colors_)) + 3 * size_;
    if (white_ == 1.0F) {
      std::copy_n(rgb, 3 * n, out);
    } else {
      for (std::size_t i = 0; i < 3 * n; ++i) out[i] = rgb[i] / white_;
    }
  }
  size_ += n;
}

void ColorStore::widen_to_shorts() {
  auto* bytes = std::get_if<Array<Rgb8>>(&colors_);
  if (bytes == nullptr) return;
  Array<Rgb16> wide(max_points_);
  convert(channels(*bytes), 3 * size_, channels(wide));
  for (std::size_t i = 0; i < 3 * size_; ++i) bits_ |= channels(wide)[i];
  colors_ = std::move(wide);
}

void ColorStore::widen_to_floats() {
  Array<RgbF> wide(max_points_);
  white_ = white_for(highest_);
  const auto divide = [&](auto& colors) {
    for (std::size_t i = 0; i < 3 * size_; ++i) channels(wide)[i] = static_cast<float>(channels(colors)[i]) / white_;
  };
  if (auto* bytes = std::get_if<Array<Rgb8>>(&colors_)) divide(*bytes);
  if (auto* shorts = std::get_if<Array<Rgb16>>(&colors_)) divide(*shorts);
  colors_ = std::move(wide);
}

void ColorStore::set_white(float white) {
  float* values = channels(std::get<Array<RgbF>>(colors_));
  for (std::size_t i = 0; i < 3 * size_; ++i) values[i] = values[i] * white_ / white;
  white_ = white;
}

void ColorStore::select(const Array<std::uint8_t>& keep) {
  std::visit(
      [&]<class T>(T& colors) {
        if constexpr (!std::is_same_v<T, std::monostate>) {
          std::size_t out = 0;
          for (std::size_t i = 0; i < size_; ++i) {
            if (keep[i] != 0) colors[out++] = colors[i];
          }
          size_ = out;
        }
      },
      colors_);
}

/// Below zero lie the undershoots of fractions alone.
void ColorStore::check_lowest(const ByteSource& source) const {
  if (lowest_ >= 0.0F) return;
  const std::string& name = declaration_.names[lowest_channel_];
  if (declaration_.type == ScalarType::kInt8) {
    source.fail(
        "point {}: {} = {:g}, of a signed type; if these are bytes from 0 to 255, they are to be declared as "
        "uchar",
        lowest_point_ + 1, name, lowest_);
  }
  const bool whole_type = declaration_.type && !is_floating(*declaration_.type);
  if (!whole_type && lowest_ >= kUndershoot * white_for(highest_)) return;
  source.fail("point {}: {} = {:g}, but colors are not negative", lowest_point_ + 1, name, lowest_);
}

Colors ColorStore::finish(const ByteSource& source, FileInfo& info) {
  if (declaration_.storage == ColorStorage::kNone || size_ == 0) return {};
  check_lowest(source);
  if (std::string reason = packed_.why_no_color(); !reason.empty()) {
    info.warnings.push_back({"no_color_stored", std::move(reason)});
    return {};
  }
  if (n_without_color_ == size_) {
    info.warnings.push_back({"no_color_stored", "no color: none of the stored ones is a number (NaN)"});
    return {};
  }
  if (highest_ <= 0.0F) {
    info.warnings.push_back({"no_color_stored", "no color: all that are stored are black (0 0 0)"});
    return {};
  }
  settle(info);
  if (const auto rounded = packed_.rounded()) info.warnings.push_back(*rounded);
  if (n_without_color_ > 0) {
    info.warnings.push_back(
        {"points_without_color",
         fmt::format("{} of {} points have no color (NaN); they count for geometry alone", n_without_color_, size_)});
  }
  warn_of_odd_colors(colors_, {highest_, std::holds_alternative<Array<RgbF>>(colors_) ? white_ : 0.0F, bits_}, info);
  return std::move(colors_);
}

/// Decides what the numbers mean, now that all are known.
void ColorStore::settle(FileInfo& info) {
  const bool is_float = !declaration_.type || is_floating(*declaration_.type);
  if (std::holds_alternative<Array<Rgb8>>(colors_)) {
    if (is_float && declaration_.storage == ColorStorage::kSeparate && highest_ <= 1.0F) widen_to_floats();
  } else if (auto* shorts = std::get_if<Array<Rgb16>>(&colors_); shorts != nullptr && (bits_ & 0xff) == 0) {
    Array<Rgb8> narrow(size_);
    for (std::size_t i = 0; i < 3 * size_; ++i)
      channels(narrow)[i] = static_cast<std::uint8_t>(channels(*shorts)[i] >> 8);
    info.notes.emplace_back("16-bit colors that are 8-bit ones times 256: divided by 256, so that white is white");
    info.color_scale = "16 bit, 8-bit values times 256";
    highest_ /= 256.0F;
    colors_ = std::move(narrow);
  }
  std::visit(
      [&]<class T>(T& colors) {
        if constexpr (!std::is_same_v<T, std::monostate>) {
          colors.resize(size_);
          if (2 * size_ < colors.capacity()) colors.shrink_to_fit();
        }
      },
      colors_);
  if (info.color_scale.empty()) {
    info.color_scale = color_scale_text(colors_, white_, declaration_);
    if (std::string note = color_scale_note(colors_, white_, declaration_); !note.empty()) info.notes.push_back(note);
  }
  cut_overshoots(info);
}

void ColorStore::cut_overshoots(FileInfo& info) {
  auto* colors = std::get_if<Array<RgbF>>(&colors_);
  if (colors == nullptr || (lowest_ >= 0.0F && highest_ <= white_)) return;
  std::uint64_t n_cut = 0;
  for (RgbF& color : *colors) {
    bool cut = false;
    for (float& value : color) {
      cut = cut || value < -kRounding || value > 1.0F + kRounding;
      if (value < 0.0F) value = 0.0F;
      if (value > 1.0F) value = 1.0F;
    }
    n_cut += cut ? 1 : 0;
  }
  if (n_cut == 0) return;
  info.warnings.push_back(
      {"colors_cut", fmt::format("{} of {} colors leave the range of 0 to {:g} (they reach from {:g} to {:g}) and were "
                                 "cut to it",
                                 n_cut, size_, white_, lowest_, highest_)});
}

}  // namespace cmap
