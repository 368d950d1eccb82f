#include "clouds/position_store.hpp"

#include <algorithm>

#include "cmap/core/sampled_indices.hpp"

namespace cmap {
namespace {

// 48 MiB of doubles: beyond the size up to which malloc keeps freed memory to itself.
constexpr std::size_t kChunkPoints = std::size_t{1} << 21;

/// Moves the points that are not at zero to the front and appends to `keep` which stay; returns how many do.
template <class Positions>
std::size_t move_nonzero(Positions& positions, std::size_t n, Array<std::uint8_t>& keep) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool stays = !positions[i].isZero(0);
    if (stays) positions[out++] = positions[i];
    keep.push_back(stays ? 1 : 0);
  }
  return out;
}

}  // namespace

Array<std::uint8_t> FloatPositions::drop_zeros() {
  Array<std::uint8_t> keep;
  kept_ = move_nonzero(positions_, kept_, keep);
  return keep;
}

Array<std::uint8_t> DoublePositions::drop_zeros() {
  Array<std::uint8_t> keep;
  for (Chunk& chunk : chunks_) chunk.kept = move_nonzero(chunk.positions, chunk.kept, keep);
  return keep;
}

std::vector<Eigen::Vector3d> FloatPositions::sample(std::size_t n) const {
  std::vector<Eigen::Vector3d> sample;
  for (const std::size_t i : sampled_indices(kept_, n)) sample.push_back(positions_[i].cast<double>());
  return sample;
}

std::vector<Eigen::Vector3d> DoublePositions::sample(std::size_t n) const {
  std::vector<Eigen::Vector3d> sample;
  auto chunk = chunks_.begin();
  std::size_t before = 0;  // points of the chunks before
  for (const std::size_t i : sampled_indices(size(), n)) {
    while (i - before >= chunk->kept) before += (chunk++)->kept;
    sample.push_back(chunk->positions[i - before]);
  }
  return sample;
}

Array<Eigen::Vector3f> FloatPositions::take(const Eigen::Vector3d& origin) {
  trim(positions_, kept_);
  if (origin != Eigen::Vector3d::Zero()) {
    for (Eigen::Vector3f& p : positions_) p = (p.cast<double>() - origin).cast<float>();
  }
  return std::move(positions_);
}

DoublePositions::DoublePositions(std::size_t max_points) : chunk_points_(std::min(max_points, kChunkPoints)) {}

double* DoublePositions::room(std::size_t n) {
  if (chunks_.empty() || n > chunks_.back().positions.size() - chunks_.back().kept) {
    chunks_.push_back({Array<Eigen::Vector3d>(std::max(n, chunk_points_)), 0});
  }
  return chunks_.back().positions.data()->data() + 3 * chunks_.back().kept;
}

std::size_t DoublePositions::size() const {
  std::size_t n = 0;
  for (const Chunk& chunk : chunks_) n += chunk.kept;
  return n;
}

Array<Eigen::Vector3f> DoublePositions::take(const Eigen::Vector3d& origin) {
  Array<Eigen::Vector3f> positions(size());
  Eigen::Vector3f* out = positions.data();
  for (Chunk& chunk : chunks_) {
    for (std::size_t i = 0; i < chunk.kept; ++i) *out++ = (chunk.positions[i] - origin).cast<float>();
    chunk.positions = {};
  }
  chunks_.clear();
  return positions;
}

}  // namespace cmap
