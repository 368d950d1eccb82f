#include "cmap/recon/fusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"

namespace cmap {
namespace {

constexpr std::size_t kPointChunk = 8192;
constexpr double kMostVoxels = 1e9;  ///< from the world's origin, along an axis

struct Placed {
  VoxelKey key;
  Eigen::Vector3f offset;  ///< from the voxel's corner
};

}  // namespace

MapFusion::MapFusion(double voxel_m) : voxel_m_(voxel_m) {
  if (!(voxel_m > 0.0) || !std::isfinite(voxel_m)) {
    throw UsageError(fmt::format("fusion_voxel_m is {:g}: above 0 is needed", voxel_m));
  }
}

void MapFusion::add(const FramePoints& points, const Eigen::Isometry3d& T_world_camera, double scale) {
  Array<Placed> placed(points.positions.size());
  parallel_chunks(placed.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d p = T_world_camera * (scale * points.positions[i].cast<double>());
      const Eigen::Vector3d cell = (p / voxel_m_).array().floor();
      if (!(cell.cwiseAbs().maxCoeff() < kMostVoxels)) {
        throw UsageError(fmt::format("fusion_voxel_m {:g} is too small for a point at {:g} {:g} {:g} m", voxel_m_,
                                     p.x(), p.y(), p.z()));
      }
      const Eigen::Vector3i key = cell.cast<int>();
      placed[i] = {{key.x(), key.y(), key.z()}, (p - voxel_m_ * cell).cast<float>()};
    }
  });
  ++frame_;
  n_added_ += placed.size();
  for (std::size_t i = 0; i < placed.size(); ++i) {
    Voxel& voxel = voxels_[placed[i].key];
    if (voxel.frame != frame_) {
      close_frame(voxel);
      voxel.frame = frame_;
    }
    const float weight = points.confidence[i];
    voxel.offset_sum += weight * placed[i].offset;
    voxel.weight += weight;
    ++voxel.n;
    if (voxel.n_in_frame == std::numeric_limits<std::uint16_t>::max()) continue;
    for (std::size_t c = 0; c < 3; ++c) voxel.color_sum[c] += points.colors[i][c];
    ++voxel.n_in_frame;
  }
}

/// The frame's mean color joins those that are kept; the first ones stay, as what is seen from near comes late as often
/// as early.
void MapFusion::close_frame(Voxel& voxel) {
  if (voxel.n_in_frame == 0) return;
  if (voxel.n_frames < kColorsPerVoxel) {
    Rgb8& color = voxel.colors[voxel.n_frames++];
    for (std::size_t c = 0; c < 3; ++c) {
      color[c] = static_cast<std::uint8_t>(std::lround(voxel.color_sum[c] / static_cast<float>(voxel.n_in_frame)));
    }
  }
  voxel.color_sum = {};
  voxel.n_in_frame = 0;
}

RgbF MapFusion::color_of(Voxel voxel) {
  constexpr double kWidth = 0.1 * 255.0;
  close_frame(voxel);
  const std::size_t n = voxel.n_frames;
  Eigen::Vector3d median = Eigen::Vector3d::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<std::uint8_t, kColorsPerVoxel> values;
    values.fill(255);  // behind those of frames
    for (std::size_t k = 0; k < n; ++k) values[k] = voxel.colors[k][c];
    std::ranges::sort(values);
    median[static_cast<Eigen::Index>(c)] = 0.5 * (values[(n - 1) / 2] + values[n / 2]);
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector3d color(voxel.colors[k][0], voxel.colors[k][1], voxel.colors[k][2]);
    const double weight = 1.0 / (1.0 + (color - median).squaredNorm() / (kWidth * kWidth));
    sum += weight * color;
    weights += weight;
  }
  const Eigen::Vector3f mean = (sum / (255.0 * weights)).cast<float>();
  return {mean.x(), mean.y(), mean.z()};
}

/// By voxel, 1 for those that stay.
Array<std::uint8_t> MapFusion::trusted(double doubt) const {
  constexpr double kQuantile = 0.75;
  const auto& entries = voxels_.entries();
  const auto confidence = [&](std::size_t i) {
    return entries[i].value.weight / static_cast<float>(entries[i].value.n);
  };
  const auto cell_of = [](const VoxelKey& key) {
    const auto down = [](std::int32_t v) { return v >= 0 ? v / kDoubtCell : -((-v - 1) / kDoubtCell) - 1; };
    return VoxelKey{down(key.x), down(key.y), down(key.z)};
  };
  VoxelMap<std::vector<float>> cells;
  for (std::size_t i = 0; i < entries.size(); ++i) cells[cell_of(entries[i].key)].push_back(confidence(i));
  VoxelMap<float> typical;
  for (const auto& cell : cells.entries()) {
    std::vector<float> values = cell.value;
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, place);
    typical[cell.key] = *place;
  }
  VoxelMap<float> best;
  for (const auto& [key, unused] : typical.entries()) {
    float& around = best[key];
    for (int step = 0; step < 27; ++step) {
      const float* value = typical.find({key.x + step % 3 - 1, key.y + step / 3 % 3 - 1, key.z + step / 9 - 1});
      if (value != nullptr) around = std::max(around, *value);
    }
  }
  Array<std::uint8_t> stays(entries.size());
  parallel_chunks(entries.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      stays[i] = confidence(i) >= doubt * static_cast<double>(*best.find(cell_of(entries[i].key))) ? 1 : 0;
    }
  });
  return stays;
}

PointCloud MapFusion::finish(double doubt) const {
  const auto& entries = voxels_.entries();
  PointCloud map;
  if (entries.empty()) return map;
  const auto corner = [&](const VoxelKey& key) -> Eigen::Vector3d {
    return voxel_m_ * Eigen::Vector3d(key.x, key.y, key.z);
  };
  Box3d box{corner(entries[0].key), corner(entries[0].key)};
  for (const auto& entry : entries) {
    box.min = box.min.cwiseMin(corner(entry.key));
    box.max = box.max.cwiseMax(corner(entry.key));
  }
  map.origin = choose_origin(box);
  map.positions.resize(entries.size());
  Array<RgbF> colors(entries.size());
  parallel_chunks(entries.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [key, voxel] = entries[i];
      const Eigen::Vector3d offset = (voxel.offset_sum / voxel.weight).cast<double>();
      map.positions[i] = (corner(key) + offset - map.origin).cast<float>();
      colors[i] = color_of(voxel);
    }
  });
  map.colors = std::move(colors);
  return doubt > 0.0 ? select(map, trusted(doubt)) : map;
}

}  // namespace cmap
