#include "clouds/cloud_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cmap/geometry/core_box.hpp"
#include "cmap/geometry/point_extent.hpp"

namespace cmap {
namespace {

// More points exactly at 0 0 0 than a sensor could measure there.
constexpr std::uint64_t kManyZeros = 10;
constexpr double kManyZerosShare = 1e-3;

template <class Real>
bool is_return(Real value) {
  return std::abs(static_cast<double>(value)) < CloudBuilder::kNoReturn_m;
}

template <class Real>
bool all_stay(const PointExtent<Real>& bounds) {
  return bounds.finite && std::all_of(bounds.min.begin(), bounds.min.end(), is_return<Real>) &&
         std::all_of(bounds.max.begin(), bounds.max.end(), is_return<Real>);
}

template <class Real>
bool is_zero(const Real* point) {
  return point[0] == Real{0} && point[1] == Real{0} && point[2] == Real{0};
}

/// How many points lie exactly at 0 0 0; the box around the others grows.
template <class Real>
std::uint64_t add_to_box(const Real* xyz, std::size_t n, const PointExtent<Real>& bounds, Box3d& box) {
  const auto spans_zero = [&](std::size_t axis) { return bounds.min[axis] <= Real{0} && bounds.max[axis] >= Real{0}; };
  std::uint64_t n_zero = 0;
  if (spans_zero(0) && spans_zero(1) && spans_zero(2)) {
    for (std::size_t i = 0; i < n; ++i) n_zero += is_zero(xyz + 3 * i) ? 1 : 0;
  }
  const auto grow = [&](const Real* low, const Real* high) {
    using Triple = Eigen::Matrix<Real, 3, 1>;
    box.min = box.min.cwiseMin(Eigen::Map<const Triple>(low).template cast<double>());
    box.max = box.max.cwiseMax(Eigen::Map<const Triple>(high).template cast<double>());
  };
  if (n_zero == 0) {
    grow(bounds.min.data(), bounds.max.data());
  } else {
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_zero(xyz + 3 * i)) grow(xyz + 3 * i, xyz + 3 * i);
    }
  }
  return n_zero;
}

}  // namespace

CloudBuilder::CloudBuilder(const ByteSource& source, CloudLayout layout, std::uint64_t max_points)
    : source_(source),
      max_points_(max_points),
      positions_(std::in_place_type<FloatPositions>, 0),
      colors_(std::move(layout.color), max_points) {
  if (layout.wide) {
    positions_.emplace<DoublePositions>(max_points);
  } else {
    positions_.emplace<FloatPositions>(max_points);
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  box_ = {Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity)};
}

void CloudBuilder::append(const PointColumns& columns, std::size_t n) {
  if (n > max_points_ - seen_) throw std::logic_error("CloudBuilder: more points than announced");
  std::visit(
      [&](auto& positions) {
        for (std::size_t first = 0; first < n; first += ColorStore::kPiece) {
          append_piece(positions, columns, first, std::min(ColorStore::kPiece, n - first));
        }
      },
      positions_);
}

template <class Positions>
void CloudBuilder::append_piece(Positions& positions, const PointColumns& columns, std::size_t first, std::size_t n) {
  using Real = typename Positions::Real;
  Real* xyz = positions.room(n);
  decode_positions(columns, first, n, xyz);
  PointExtent<Real> bounds = point_extent(xyz, n);
  const bool stay = all_stay(bounds);
  const std::size_t n_kept = stay ? n : filter(xyz, n);
  if (n_kept > 0) {
    if (!stay) bounds = point_extent(xyz, n_kept);
    n_at_zero_ += add_to_box(xyz, n_kept, bounds, box_);
    colors_.append(source_, columns, first, n, stay ? nullptr : &kept_rows_, seen_);
  }
  positions.keep(n_kept);
  kept_ += n_kept;
  seen_ += n;
}

/// Moves the points that stay to the front; returns how many, and which in kept_rows_.
template <class Real>
std::size_t CloudBuilder::filter(Real* xyz, std::size_t n) {
  kept_rows_.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const Real* point = xyz + 3 * i;
    if (!std::all_of(point, point + 3, [](Real value) { return std::isfinite(value); })) continue;
    if (!std::all_of(point, point + 3, is_return<Real>)) {
      ++n_no_return_;
      continue;
    }
    std::copy(point, point + 3, xyz + 3 * kept_rows_.size());
    kept_rows_.push_back(static_cast<std::uint32_t>(i));
  }
  return kept_rows_.size();
}

void CloudBuilder::leave_out(std::string_view reason, std::uint64_t n) {
  if (n > max_points_ - seen_) throw std::logic_error("CloudBuilder: more points than announced");
  seen_ += n;
  count_left_out(reason, n);
}

void CloudBuilder::count_left_out(std::string_view reason, std::uint64_t n) {
  if (n == 0) return;
  const auto known =
      std::find_if(left_out_.begin(), left_out_.end(), [&](const LeftOut& some) { return some.reason == reason; });
  if (known != left_out_.end()) {
    known->n += n;
  } else {
    left_out_.push_back({std::string(reason), n});
  }
}

/// Points at 0 0 0 that stand for "no return" are known by their number, so only at the end.
void CloudBuilder::drop_many_zeros() {
  if (n_at_zero_ == 0) return;
  const bool many =
      n_at_zero_ >= kManyZeros && static_cast<double>(n_at_zero_) >= kManyZerosShare * static_cast<double>(kept_);
  if (!many) {
    box_ = {box_.min.cwiseMin(Eigen::Vector3d::Zero()), box_.max.cwiseMax(Eigen::Vector3d::Zero())};
    return;
  }
  const Array<std::uint8_t> keep = std::visit([](auto& positions) { return positions.drop_zeros(); }, positions_);
  colors_.select(keep);
  kept_ -= n_at_zero_;
  count_left_out("no return (exactly at 0 0 0)", n_at_zero_);
}

void CloudBuilder::describe(FileInfo& info) {
  info.points = seen_;
  info.finite_points = kept_;
  info.left_out = std::move(left_out_);
  if (seen_ == 0) source_.fail("holds no points");
  std::string reasons;
  for (const LeftOut& points : info.left_out) reasons += fmt::format("; {} left out: {}", points.n, points.reason);
  if (kept_ == 0) {
    const bool any_left_out = !info.left_out.empty();
    source_.fail("none of its {} points is {}{}", seen_, any_left_out ? "left" : "finite", reasons);
  }
  for (const LeftOut& points : info.left_out) {
    info.notes.push_back(fmt::format("{} of {} points left out: {}", points.n, seen_, points.reason));
  }
}

PointCloud CloudBuilder::finish(FileInfo& info) {
  count_left_out("no return (a coordinate of 1e9 or more)", n_no_return_);
  drop_many_zeros();
  describe(info);
  PointCloud cloud;
  const auto sample = std::visit([](const auto& positions) { return positions.sample(kCoreSample); }, positions_);
  cloud.origin = choose_origin(box_, cloud_core(sample));
  cloud.positions = std::visit([&](auto& positions) { return positions.take(cloud.origin); }, positions_);
  cloud.colors = colors_.finish(source_, info);
  return cloud;
}

}  // namespace cmap
