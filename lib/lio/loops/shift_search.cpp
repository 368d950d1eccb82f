#include "loops/shift_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace cmap {
namespace {

constexpr int kApartCells = 4;
constexpr double kApartTurn_rad = 0.35;

/// Sums of products, a row a shift in y.
struct ShiftScores {
  int first_x, first_y, width;  ///< shifts in cells
  std::vector<float> sums;
  float at(int i, int k) const {
    return sums[static_cast<std::size_t>(k) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
  }
};

/// Adds value * the target's cells at the shifts of one row.
void add_row(const BirdsEyeImage& target, int x, int y, float value, float* sums, int width) {
  if (y < 0 || y >= target.side) return;
  const int begin = std::max(0, -x), end = std::min(width, target.side - x);
  const float* const row = target.values.data() + static_cast<std::ptrdiff_t>(y) * target.side + x;
  for (int i = begin; i < end; ++i) sums[i] += value * row[i];
}

ShiftScores scores_of(const BirdsEye& source, const BirdsEyeImage& target, double yaw_rad, int first_x, int first_y,
                      int width) {
  ShiftScores scores{first_x, first_y, width,
                     std::vector<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(width), 0.0F)};
  const Eigen::Rotation2Df turn(static_cast<float>(yaw_rad));
  for (const BirdsEye::Cell& cell : source.cells) {
    const Eigen::Vector2f p = turn * cell.center;
    const int x = static_cast<int>(std::floor(static_cast<double>(p.x()) / source.cell_m)) + source.side / 2;
    const int y = static_cast<int>(std::floor(static_cast<double>(p.y()) / source.cell_m)) + source.side / 2;
    for (int k = 0; k < width; ++k) {
      add_row(target, x + first_x, y + first_y + k, cell.value,
              scores.sums.data() + static_cast<std::ptrdiff_t>(k) * width, width);
    }
  }
  return scores;
}

/// Where the parabola through three values has its top, from the middle one.
double top_of(double before, double middle, double after) {
  const double bend = before - 2.0 * middle + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

/// Of a source and a target.
double norms_of(const BirdsEye& source, const BirdsEyeImage& target) {
  double sq_source = 0.0, sq_target = 0.0;
  for (const BirdsEye::Cell& cell : source.cells) sq_source += static_cast<double>(cell.value * cell.value);
  for (const float v : target.values) sq_target += static_cast<double>(v * v);
  return std::sqrt(sq_source * sq_target);
}

/// The highest top at least kApartCells from another, if any; the outermost shifts are there for their neighbors only.
std::optional<Eigen::Vector2i> highest(const ShiftScores& scores, const std::optional<Eigen::Vector2i>& other) {
  std::optional<Eigen::Vector2i> best;
  for (int k = 1; k + 1 < scores.width; ++k) {
    for (int i = 1; i + 1 < scores.width; ++i) {
      const float v = scores.at(i, k);
      if (best && !(v > scores.at(best->x(), best->y()))) continue;
      if (other) {
        const bool is_near = (Eigen::Vector2i(i, k) - *other).cwiseAbs().maxCoeff() < kApartCells;
        const bool is_top = v >= scores.at(i - 1, k) && v >= scores.at(i + 1, k) && v >= scores.at(i, k - 1) &&
                            v >= scores.at(i, k + 1);
        if (is_near || !is_top) continue;
      }
      best = Eigen::Vector2i(i, k);
    }
  }
  return best;
}

}  // namespace

std::vector<PlanarPose> best_shifts(const BirdsEye& source, const BirdsEyeImage& target, double yaw_rad,
                                    const Eigen::Vector2d& about_m, double window_m) {
  const int reach = static_cast<int>(std::ceil(window_m / source.cell_m)) + 1;
  const Eigen::Vector2i about = (about_m / source.cell_m).array().round().matrix().cast<int>();
  const double norms = norms_of(source, target);
  if (!(norms > 0.0)) return {{yaw_rad, about_m, 0.0}};
  const ShiftScores scores = scores_of(source, target, yaw_rad, about.x() - reach, about.y() - reach, 2 * reach + 1);
  std::vector<PlanarPose> poses;
  std::optional<Eigen::Vector2i> top = highest(scores, std::nullopt);
  for (int n = 0; n < 2 && top; ++n) {
    const auto value = [&](int dx, int dy) { return static_cast<double>(scores.at(top->x() + dx, top->y() + dy)); };
    const Eigen::Vector2d finer(top_of(value(-1, 0), value(0, 0), value(1, 0)),
                                top_of(value(0, -1), value(0, 0), value(0, 1)));
    const Eigen::Vector2d cells = Eigen::Vector2d(scores.first_x, scores.first_y) + top->cast<double>() + finer;
    poses.push_back({yaw_rad, source.cell_m * cells, value(0, 0) / norms});
    if (n == 0) top = highest(scores, top);
  }
  return poses;
}

std::vector<PlanarPose> best_planar_poses(const BirdsEye& source, const BirdsEyeImage& target,
                                          std::span<const double> yaws_rad, const Eigen::Vector2d& about_m,
                                          double window_m) {
  std::vector<PlanarPose> all;
  for (const double yaw_rad : yaws_rad) {
    for (const PlanarPose& pose : best_shifts(source, target, yaw_rad, about_m, window_m)) all.push_back(pose);
  }
  std::stable_sort(all.begin(), all.end(), [](const PlanarPose& a, const PlanarPose& b) { return a.score > b.score; });
  const auto is_apart = [&](const PlanarPose& pose) {
    const double turn_rad = std::abs(std::remainder(pose.yaw_rad - all.front().yaw_rad, 2.0 * std::numbers::pi));
    const Eigen::Vector2d shift = (pose.shift_m - all.front().shift_m) / source.cell_m;
    return turn_rad > kApartTurn_rad || shift.cwiseAbs().maxCoeff() >= kApartCells;
  };
  const auto second = std::find_if(all.begin(), all.end(), is_apart);
  if (second != all.end()) return {all.front(), *second};
  return {all.begin(), all.begin() + std::min<std::ptrdiff_t>(1, std::ssize(all))};
}

}  // namespace cmap
