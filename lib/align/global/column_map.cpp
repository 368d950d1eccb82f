#include "global/column_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cmap {
namespace {

constexpr std::array<double, 3> kLayers{1.5, 4.0, 8.0};
constexpr int kGroundReach = 6;       ///< cells around a cell that its ground is taken from
constexpr double kGroundShare = 0.1;  ///< rank of it among their lowest points: below are strays

/// The chance that a word is not seen again, for reasons that cutting into other cells does not show: noise, occlusion.
constexpr double kUnlike = 0.2;
constexpr double kPriorCount = 0.5;

/// The lowest point of each cell; infinity where it is empty.
std::vector<float> lowest_points(const ColumnMap& map, const std::vector<std::size_t>& cell_of,
                                 const std::vector<Eigen::Vector3f>& points) {
  std::vector<float> lowest(map.word.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < points.size(); ++i) {
    lowest[cell_of[i]] = std::min(lowest[cell_of[i]], points[i].z());
  }
  return lowest;
}

float ground_around(const ColumnMap& map, const std::vector<float>& lowest, int x, int y, std::vector<float>& near) {
  near.clear();
  for (int v = std::max(0, y - kGroundReach); v <= std::min(map.height - 1, y + kGroundReach); ++v) {
    for (int u = std::max(0, x - kGroundReach); u <= std::min(map.width - 1, x + kGroundReach); ++u) {
      const float low = lowest[static_cast<std::size_t>(v * map.width + u)];
      if (std::isfinite(low)) near.push_back(low);
    }
  }
  if (near.empty()) return 0.0f;
  const auto rank = static_cast<std::ptrdiff_t>(kGroundShare * static_cast<double>(near.size()));
  std::nth_element(near.begin(), near.begin() + rank, near.end());
  return near[static_cast<std::size_t>(rank)];
}

/// Cells inside a roof or a yard repeat what their neighbors say.
float told_by(const ColumnMap& map, int x, int y) {
  constexpr float kLeast = 0.15f;
  int like = 0;
  for (int v = y - 1; v <= y + 1; ++v) {
    for (int u = x - 1; u <= x + 1; ++u) like += map.word_at(u, v) == map.word_at(x, y) ? 1 : 0;
  }
  return std::sqrt(std::max(kLeast, static_cast<float>(9 - like) / 8.0f));
}

std::uint8_t layer_bit(double above_m, double layer_m) {
  int layer = 0;
  for (const double top : kLayers) layer += above_m >= top * layer_m ? 1 : 0;
  return static_cast<std::uint8_t>(1 << layer);
}

}  // namespace

ColumnMap::ColumnMap(std::span<const Eigen::Vector3f> points, const Eigen::Matrix3d& turned, double cell, double layer,
                     double phase)
    : upright(turned), cell_m(cell), layer_m(layer) {
  const Eigen::Matrix3f R = upright.cast<float>();
  std::vector<Eigen::Vector3f> moved(points.size());
  Eigen::Vector2f low = Eigen::Vector2f::Constant(std::numeric_limits<float>::infinity()), high = -low;
  for (std::size_t i = 0; i < points.size(); ++i) {
    moved[i] = R * points[i];
    low = low.cwiseMin(moved[i].head<2>());
    high = high.cwiseMax(moved[i].head<2>());
  }
  low_m = low.cast<double>().array() - phase * cell_m;
  width = static_cast<int>((static_cast<double>(high.x()) - low_m.x()) / cell_m) + 1;
  height = static_cast<int>((static_cast<double>(high.y()) - low_m.y()) / cell_m) + 1;
  word.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kEmpty);
  ground_m.assign(word.size(), 0.0f);
  std::vector<std::size_t> cell_of(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d place = cell_at(moved[i].head<2>().cast<double>());
    const int x = std::clamp(static_cast<int>(place.x()), 0, width - 1);
    const int y = std::clamp(static_cast<int>(place.y()), 0, height - 1);
    cell_of[i] = static_cast<std::size_t>(y * width + x);
  }
  const std::vector<float> lowest = lowest_points(*this, cell_of, moved);
  std::vector<float> near;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto cell_index = static_cast<std::size_t>(y * width + x);
      if (std::isfinite(lowest[cell_index])) ground_m[cell_index] = ground_around(*this, lowest, x, y, near);
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    word[cell_of[i]] |= layer_bit(static_cast<double>(moved[i].z() - ground_m[cell_of[i]]), layer_m);
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) weight.push_back(told_by(*this, x, y));
  }
}

WordScores word_scores(std::span<const RecutColumns> maps) {
  WordScores together{};
  std::array<double, ColumnMap::kWords> alone{};
  double n = 0.0;
  for (const RecutColumns& both : maps) {
    for (int y = 0; y < both.map.height; ++y) {
      for (int x = 0; x < both.map.width; ++x) {
        const std::uint8_t a = both.map.word_at(x, y), b = both.recut.word_at(x, y);
        if (a == ColumnMap::kEmpty || b == ColumnMap::kEmpty) continue;
        together[a][b] += 0.5;
        together[b][a] += 0.5;
        alone[a] += 0.5;
        alone[b] += 0.5;
        n += 1.0;
      }
    }
  }
  WordScores scores{};
  const double all = n + kPriorCount * static_cast<double>(ColumnMap::kWords);
  for (std::size_t a = 1; a < ColumnMap::kWords; ++a) {
    for (std::size_t b = 1; b < ColumnMap::kWords; ++b) {
      const double by_chance = (alone[a] + kPriorCount) * (alone[b] + kPriorCount) / (all * all);
      const double same = n > 0.0 ? together[a][b] / n : by_chance;
      scores[a][b] = std::log(((1.0 - kUnlike) * same + kUnlike * by_chance) / by_chance);
    }
  }
  return scores;
}

}  // namespace cmap
