#include "io/cloud_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace cmap {
namespace {

// Points decoded and then checked while they are still in the cache.
constexpr std::size_t kPiece = 2048;

template <class Real>
struct PieceBounds {
  std::array<Real, 3> min, max;
  bool finite;
};

/// Bounds of n >= 1 points; four points at a time, so that the loop vectorizes.
template <class Real>
PieceBounds<Real> measure(const Real* xyz, std::size_t n) {
  constexpr std::size_t kLanes = 12;
  Real low[kLanes], high[kLanes], not_finite[kLanes] = {};
  for (std::size_t j = 0; j < kLanes; ++j) low[j] = high[j] = xyz[j % 3];
  const auto add = [&](std::size_t j, Real value) {
    low[j] = value < low[j] ? value : low[j];
    high[j] = value > high[j] ? value : high[j];
    not_finite[j] += value * Real{0};  // NaN from then on if the value is NaN or infinite
  };
  std::size_t i = 0;
  for (; i + kLanes <= 3 * n; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; ++j) add(j, xyz[i + j]);
  }
  for (; i < 3 * n; ++i) add(i % 3, xyz[i]);
  PieceBounds<Real> bounds{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}, true};
  for (std::size_t j = 0; j < kLanes; ++j) {
    bounds.min[j % 3] = std::min(bounds.min[j % 3], low[j]);
    bounds.max[j % 3] = std::max(bounds.max[j % 3], high[j]);
    bounds.finite = bounds.finite && not_finite[j] == Real{0};
  }
  return bounds;
}

template <class Real>
bool in_range(const PieceBounds<Real>& bounds) {
  const auto fits = [](Real value) { return std::abs(static_cast<double>(value)) <= kMaxCoordinate_m; };
  return bounds.finite && std::all_of(bounds.min.begin(), bounds.min.end(), fits) &&
         std::all_of(bounds.max.begin(), bounds.max.end(), fits);
}

Colors make_colors(ColorStorage storage, std::size_t n) {
  switch (storage) {
    case ColorStorage::kNone:
      break;
    case ColorStorage::kRgb8:
    case ColorStorage::kPacked:
      return Array<Rgb8>(n);
    case ColorStorage::kRgb16:
      return Array<Rgb16>(n);
    case ColorStorage::kFloat:
    case ColorStorage::kAnyFloat:
      return Array<RgbF>(n);
  }
  return {};
}

/// Calls f with the array of colors, if there is one.
template <class Variant, class F>
void with_colors(Variant& colors, F&& f) {
  std::visit(
      [&]<class T>(T& values) {
        if constexpr (!std::is_same_v<std::remove_const_t<T>, std::monostate>) f(values);
      },
      colors);
}

}  // namespace

CloudBuilder::CloudBuilder(const ByteSource& source, CloudLayout layout, std::uint64_t max_points)
    : source_(source),
      layout_(std::move(layout)),
      max_points_(max_points),
      positions_(std::in_place_type<FloatPositions>, 0) {
  if (layout_.wide) {
    positions_.emplace<DoublePositions>(max_points);
  } else {
    positions_.emplace<FloatPositions>(max_points);
  }
  colors_ = make_colors(layout_.color, max_points);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  box_ = {Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity)};
}

void CloudBuilder::append(const PointColumns& columns, std::size_t n) {
  if (n > max_points_ - seen_) throw std::logic_error("CloudBuilder: more points than announced");
  std::visit(
      [&](auto& positions) {
        for (std::size_t first = 0; first < n; first += kPiece) {
          append_piece(positions, columns, first, std::min(kPiece, n - first));
        }
      },
      positions_);
}

void CloudBuilder::leave_out(std::string_view reason, std::uint64_t n) {
  if (n > max_points_ - seen_) throw std::logic_error("CloudBuilder: more points than announced");
  if (n == 0) return;
  seen_ += n;
  const auto known = std::find_if(left_out_.begin(), left_out_.end(), [&](const auto& l) { return l.reason == reason; });
  if (known != left_out_.end()) {
    known->n += n;
  } else {
    left_out_.push_back({std::string(reason), n});
  }
}

template <class Positions>
void CloudBuilder::append_piece(Positions& positions, const PointColumns& columns, std::size_t first, std::size_t n) {
  using Real = typename Positions::Real;
  Real* xyz = positions.room(n);
  decode_positions(columns, first, n, xyz);
  decode_piece_colors(columns, first, n);
  PieceBounds<Real> bounds = measure(xyz, n);
  std::size_t n_kept = n;
  if (!in_range(bounds) || !colors_fit(n)) {
    n_kept = filter(xyz, n);
    if (n_kept > 0) bounds = measure(xyz, n_kept);
  }
  if (n_kept > 0) {
    box_.min =
        box_.min.cwiseMin(Eigen::Map<const Eigen::Matrix<Real, 3, 1>>(bounds.min.data()).template cast<double>());
    box_.max =
        box_.max.cwiseMax(Eigen::Map<const Eigen::Matrix<Real, 3, 1>>(bounds.max.data()).template cast<double>());
  }
  positions.keep(n_kept);
  kept_ += n_kept;
  seen_ += n;
}

void CloudBuilder::decode_piece_colors(const PointColumns& columns, std::size_t first, std::size_t n) {
  with_colors(colors_, [&](auto& colors) { decode_colors(columns, first, n, colors[kept_].data()); });
}

/// Moves the points that stay to the front, and their colors with them; returns how many.
template <class Real>
std::size_t CloudBuilder::filter(Real* xyz, std::size_t n) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Real* point = xyz + 3 * i;
    const auto finite = [](Real value) { return std::isfinite(value); };
    if (!std::all_of(point, point + 3, finite) || !color_is_finite(kept_ + i)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(static_cast<double>(point[axis])) <= kMaxCoordinate_m) continue;
      source_.fail("point {}: {} = {:g} is beyond the accepted +-{:g} m", seen_ + i + 1, "xyz"[axis], point[axis],
                   kMaxCoordinate_m);
    }
    if (layout_.color == ColorStorage::kFloat) check_color(i);
    std::copy(point, point + 3, xyz + 3 * out);
    with_colors(colors_, [&](auto& colors) { colors[kept_ + out] = colors[kept_ + i]; });
    ++out;
  }
  return out;
}

/// Whether the last n colors need no look at each: everything but a float outside [0,1].
bool CloudBuilder::colors_fit(std::size_t n) const {
  const auto* colors = std::get_if<Array<RgbF>>(&colors_);
  if (colors == nullptr) return true;
  const float highest = layout_.color == ColorStorage::kFloat ? 1.0F : std::numeric_limits<float>::max();
  bool fit = true;
  for (std::size_t i = kept_; i < kept_ + n; ++i) {
    for (const float value : (*colors)[i]) fit = fit && value >= 0.0F && value <= highest;
  }
  return fit;
}

bool CloudBuilder::color_is_finite(std::size_t i) const {
  const auto* colors = std::get_if<Array<RgbF>>(&colors_);
  return colors == nullptr ||
         std::all_of((*colors)[i].begin(), (*colors)[i].end(), [](float value) { return std::isfinite(value); });
}

void CloudBuilder::check_color(std::size_t i) const {
  const RgbF& color = std::get<Array<RgbF>>(colors_)[kept_ + i];
  for (std::size_t k = 0; k < 3; ++k) {
    if (color[k] >= 0.0F && color[k] <= 1.0F) continue;
    source_.fail("point {}: {} = {:g}, but colors stored as floats must lie in [0,1]{}", seen_ + i + 1,
                 layout_.color_names[k], color[k],
                 color[k] > 1.0F && color[k] <= 255.0F ? " (if they are 0..255, store them as uchar)" : "");
  }
}

PointCloud CloudBuilder::finish(FileInfo& info) {
  info.points = seen_;
  info.finite_points = kept_;
  info.left_out = std::move(left_out_);
  if (seen_ == 0) source_.fail("holds no points");
  std::string reasons;
  for (const LeftOut& points : info.left_out) reasons += fmt::format("; {} left out as {}", points.n, points.reason);
  if (kept_ == 0) source_.fail("none of its {} points is finite{}", seen_, reasons);
  const std::uint64_t not_finite = seen_ - kept_ - info.n_left_out();
  if (not_finite > 0) info.notes.push_back(fmt::format("{} of {} points dropped: not finite", not_finite, seen_));
  for (const LeftOut& points : info.left_out) {
    info.notes.push_back(fmt::format("{} of {} points left out: {}", points.n, seen_, points.reason));
  }
  PointCloud cloud;
  cloud.origin = choose_origin(box_).array() + 0.0;  // -0 becomes 0
  cloud.positions = std::visit([&](auto& positions) { return positions.take(cloud.origin); }, positions_);
  with_colors(colors_, [&](auto& colors) { trim(colors, kept_); });
  cloud.colors = std::move(colors_);
  return cloud;
}

}  // namespace cmap
