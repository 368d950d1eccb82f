#include "cmap/recon/map_fusion.hpp"

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

MapFusion::MapFusion(const FusionOptions& options) : options_(options) {
  for (const auto& [name, value] :
       {std::pair("fusion_voxel_m", options.voxel_m), std::pair("fusion_color_width", options.color_width),
        std::pair("fusion_doubt_cell_voxels", static_cast<double>(options.doubt_cell_voxels))}) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      throw UsageError(fmt::format("{} is {:g}: above 0 is needed", name, value));
    }
  }
}

void MapFusion::add(const FramePoints& points, const Eigen::Isometry3d& T_world_camera, double scale) {
  Array<Placed> placed(points.positions.size());
  parallel_chunks(placed.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d p = T_world_camera * (scale * points.positions[i].cast<double>());
      const Eigen::Vector3d cell = (p / options_.voxel_m).array().floor();
      if (!(cell.cwiseAbs().maxCoeff() < kMostVoxels)) {
        throw UsageError(fmt::format("fusion_voxel_m {:g} is too small for a point at {:g} {:g} {:g} m",
                                     options_.voxel_m, p.x(), p.y(), p.z()));
      }
      const Eigen::Vector3i key = cell.cast<int>();
      placed[i] = {{key.x(), key.y(), key.z()}, (p - options_.voxel_m * cell).cast<float>()};
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

RgbF MapFusion::color_of(Voxel voxel) const {
  const double width = options_.color_width * 255.0;
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
    const double weight = 1.0 / (1.0 + (color - median).squaredNorm() / (width * width));
    sum += weight * color;
    weights += weight;
  }
  const Eigen::Vector3f mean = (sum / (255.0 * weights)).cast<float>();
  return {mean.x(), mean.y(), mean.z()};
}

/// By voxel, 1 for those that stay.
Array<std::uint8_t> MapFusion::trusted() const {
  const auto& entries = voxels_.entries();
  const auto cell_of = [side = options_.doubt_cell_voxels](const VoxelKey& key) {
    const auto down = [side](std::int32_t v) { return v >= 0 ? v / side : -((-v - 1) / side) - 1; };
    return VoxelKey{down(key.x), down(key.y), down(key.z)};
  };
  struct Sum {
    double confidence = 0.0, n = 0.0;
  };
  VoxelMap<Sum> cells;
  for (const auto& [key, voxel] : entries) {
    Sum& sum = cells[cell_of(key)];
    sum.confidence += voxel.weight;
    sum.n += voxel.n;
  }
  VoxelMap<double> best;
  for (const auto& [key, unused] : cells.entries()) {
    double& around = best[key];
    for (int step = 0; step < 27; ++step) {
      const Sum* sum = cells.find({key.x + step % 3 - 1, key.y + step / 3 % 3 - 1, key.z + step / 9 - 1});
      if (sum != nullptr) around = std::max(around, sum->confidence / sum->n);
    }
  }
  Array<std::uint8_t> stays(entries.size());
  parallel_chunks(entries.size(), kPointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [key, voxel] = entries[i];
      stays[i] = voxel.weight / static_cast<double>(voxel.n) >= options_.doubt * *best.find(cell_of(key)) ? 1 : 0;
    }
  });
  return stays;
}

PointCloud MapFusion::finish() const {
  const auto& entries = voxels_.entries();
  PointCloud map;
  if (entries.empty()) return map;
  const auto corner = [&](const VoxelKey& key) -> Eigen::Vector3d {
    return options_.voxel_m * Eigen::Vector3d(key.x, key.y, key.z);
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
  return options_.doubt > 0.0 ? select(map, trusted()) : map;
}

}  // namespace cmap
