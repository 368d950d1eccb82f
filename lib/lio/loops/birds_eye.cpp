#include "loops/birds_eye.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace cmap {
namespace {

constexpr int kSlices = 32;
constexpr int kTall = 10;

std::size_t place(int x, int y, int side) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
}

}  // namespace

Eigen::Vector2i BirdsEye::index(const Eigen::Vector2f& p) const {
  const Eigen::Array2d cell = (p.cast<double>() / cell_m).array().floor() + side / 2;
  return cell.max(-1.0).min(side).cast<int>();
}

BirdsEye birds_eye(const PointCloud& points, double ground_m, double reach_m) {
  BirdsEye view;
  view.side = kBirdsEyeSide;
  view.cell_m = 2.0 * reach_m / view.side;
  std::vector<std::uint32_t> slices(place(0, view.side, view.side), 0);
  for (const Eigen::Vector3f& p : points.positions) {
    const Eigen::Vector2i cell = view.index(p.head<2>());
    if (cell.minCoeff() < 0 || cell.maxCoeff() >= view.side) continue;
    const double slice = std::floor((static_cast<double>(p.z()) - ground_m) / view.cell_m - 0.5);
    if (slice >= 0.0 && slice < kSlices) slices[place(cell.x(), cell.y(), view.side)] |= 1U << static_cast<int>(slice);
  }
  for (int y = 0; y < view.side; ++y) {
    for (int x = 0; x < view.side; ++x) {
      const int n = std::min(std::popcount(slices[place(x, y, view.side)]), kTall);
      if (n == 0) continue;
      const Eigen::Vector2d center = (Eigen::Vector2d(x, y).array() + 0.5 - view.side / 2) * view.cell_m;
      view.cells.push_back({center.cast<float>(), static_cast<float>(n) / kTall});
    }
  }
  return view;
}

BirdsEyeImage image_of(const BirdsEye& view) {
  BirdsEyeImage image{view.side, std::vector<float>(place(0, view.side, view.side), 0.0F)};
  for (const BirdsEye::Cell& cell : view.cells) {
    const Eigen::Vector2i i = view.index(cell.center);
    image.values[place(i.x(), i.y(), view.side)] = cell.value;
  }
  return image;
}

}  // namespace cmap
