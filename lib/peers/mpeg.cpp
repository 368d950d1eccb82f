#include "cmap/peers/mpeg.hpp"

#include <algorithm>
#include <cmath>
#include <flann/flann.hpp>
#include <stdexcept>
#include <utility>

#include "cmap/core/execution.hpp"
#include "cmap/peers/peer_tool.hpp"

// MPEG's pc_error. It asks for the ten nearest neighbors, which no other metric needs: FLANN finds them.

namespace cmap {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
using Position = std::array<float, 3>;

constexpr std::size_t kFirstNeighbors = 10;
constexpr std::size_t kMoreNeighbors = 5;
constexpr std::size_t kMaxNeighbors = 30;
constexpr double kSameSqDistance = 1e-8;
constexpr std::size_t kChunk = 1024;

/// Ordered by position, equal positions merged into one.
struct MergedCloud {
  std::vector<Position> positions;
  std::vector<double> coordinates;  // the same, for the index
  std::vector<Rgb> rgb;
};

MergedCloud merge_duplicates(const MpegCloud& cloud) {
  const std::size_t n = cloud.positions.size();
  if (n == 0) throw std::invalid_argument("mpeg_distortion: a cloud has no points");
  if (cloud.rgb.size() != n) throw std::invalid_argument("mpeg_distortion: a cloud has not one color per position");
  std::vector<std::pair<Position, std::size_t>> order(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3f& p = cloud.positions[i];
    order[i] = {{p.x(), p.y(), p.z()}, i};
  }
  std::ranges::sort(order);
  MergedCloud merged;
  for (std::size_t first = 0; first < n;) {
    std::array<std::uint64_t, 3> sum{};
    std::size_t last = first;
    for (; last < n && order[last].first == order[first].first; ++last) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += cloud.rgb[order[last].second][c];
    }
    Rgb mean{};
    for (std::size_t c = 0; c < 3; ++c) mean[c] = static_cast<std::uint8_t>(sum[c] / (last - first));  // truncated
    merged.positions.push_back(order[first].first);
    merged.rgb.push_back(mean);
    for (const float v : order[first].first) merged.coordinates.push_back(static_cast<double>(v));
    first = last;
  }
  return merged;
}

/// The tool subtracts floats and squares doubles.
double sq_distance(const Position& a, const Position& b) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double d = static_cast<double>(a[c] - b[c]);
    sum += d * d;
  }
  return sum;
}

std::array<float, 3> bt709(const Rgb& rgb) {
  const double r = rgb[0];
  const double g = rgb[1];
  const double b = rgb[2];
  return {static_cast<float>((0.2126 * r + 0.7152 * g + 0.0722 * b) / 255.0),
          static_cast<float>((-0.1146 * r - 0.3854 * g + 0.5 * b) / 255.0 + 0.5),
          static_cast<float>((0.5 * r - 0.4542 * g - 0.0458 * b) / 255.0 + 0.5)};
}

struct Neighbor {
  double sq_dist;
  std::size_t index;
};

class MpegSearch {
 public:
  explicit MpegSearch(MergedCloud& cloud)
      : cloud_(cloud),
        index_(flann::Matrix<double>(cloud.coordinates.data(), cloud.positions.size(), 3),
               flann::KDTreeSingleIndexParams(10)) {
    index_.buildIndex();
  }

  /// 10 nearest; 5 more while all of them are equally far, up to 30.
  void nearest(const Position& query, std::vector<Neighbor>& out) const {
    for (std::size_t k = kFirstNeighbors;; k += kMoreNeighbors) {
      knn(query, std::min(k, cloud_.positions.size()), out);
      const bool all_equal = out.front().sq_dist == out.back().sq_dist;
      if (!all_equal || k + kMoreNeighbors > kMaxNeighbors || k >= cloud_.positions.size()) return;
    }
  }

  /// Mean color of the nearest and of those that follow it in steps below 1e-8 m^2.
  Rgb color(std::span<const Neighbor> near) const {
    std::array<unsigned, 3> sum{};
    unsigned count = 0;
    for (std::size_t k = 0; k < near.size(); ++k) {
      if (k > 0 && !(std::abs(near[k].sq_dist - near[k - 1].sq_dist) < kSameSqDistance)) break;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += cloud_.rgb[near[k].index][c];
      ++count;
    }
    Rgb mean{};
    for (std::size_t c = 0; c < 3; ++c) {
      mean[c] = static_cast<std::uint8_t>(std::round(static_cast<double>(sum[c]) / count));
    }
    return mean;
  }

 private:
  void knn(const Position& query, std::size_t k, std::vector<Neighbor>& out) const {
    std::array<double, 3> q{static_cast<double>(query[0]), static_cast<double>(query[1]),
                            static_cast<double>(query[2])};
    std::array<std::size_t, kMaxNeighbors> index{};
    std::array<double, kMaxNeighbors> sq{};
    flann::Matrix<std::size_t> index_row(index.data(), 1, k);
    flann::Matrix<double> sq_row(sq.data(), 1, k);
    index_.knnSearch(flann::Matrix<double>(q.data(), 1, 3), index_row, sq_row, k,
                     flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    out.clear();
    for (std::size_t i = 0; i < k; ++i) out.push_back({sq_distance(query, cloud_.positions[index[i]]), index[i]});
    std::ranges::sort(out, {}, [](const Neighbor& a) { return std::pair(a.sq_dist, a.index); });
  }

  const MergedCloud& cloud_;
  flann::Index<flann::L2<double>> index_;
};

double color_psnr(double mse) { return 10 * std::log10(1 / mse); }

/// Loop over `from`, search in `to`.
MpegDirection one_way(const MergedCloud& from, const MpegSearch& to) {
  MpegDirection result;
  std::vector<Neighbor> near;
  for (std::size_t i = 0; i < from.positions.size(); ++i) {
    if (i % kChunk == 0) throw_if_stopped();
    to.nearest(from.positions[i], near);
    result.point_mse_m2 += near.front().sq_dist;
    result.sq_hausdorff_m2 = std::max(result.sq_hausdorff_m2, near.front().sq_dist);
    const auto own = bt709(from.rgb[i]);
    const auto other = bt709(to.color(near));
    for (std::size_t c = 0; c < 3; ++c) {
      const float d = own[c] - other[c];
      result.color_mse[c] += static_cast<double>(d * d);
    }
  }
  const double n = static_cast<double>(from.positions.size());
  result.point_mse_m2 /= n;
  for (std::size_t c = 0; c < 3; ++c) {
    result.color_mse[c] /= n;
    result.color_psnr_db[c] = color_psnr(result.color_mse[c]);
  }
  return result;
}

MpegDirection worse(const MpegDirection& a, const MpegDirection& b) {
  MpegDirection result;
  result.point_mse_m2 = std::max(a.point_mse_m2, b.point_mse_m2);
  result.sq_hausdorff_m2 = std::max(a.sq_hausdorff_m2, b.sq_hausdorff_m2);
  for (std::size_t c = 0; c < 3; ++c) {
    result.color_mse[c] = std::max(a.color_mse[c], b.color_mse[c]);
    result.color_psnr_db[c] = std::min(a.color_psnr_db[c], b.color_psnr_db[c]);
  }
  return result;
}

}  // namespace

MpegDistortion mpeg_distortion(const MpegCloud& reference, const MpegCloud& estimate) {
  MergedCloud a = merge_duplicates(reference);
  MergedCloud b = merge_duplicates(estimate);
  MpegDistortion result;
  result.reference_to_estimate = one_way(a, MpegSearch(b));
  result.estimate_to_reference = one_way(b, MpegSearch(a));
  result.symmetric = worse(result.reference_to_estimate, result.estimate_to_reference);
  return result;
}

namespace {

MpegCloud mpeg_cloud(const IndexedMap& map) {
  MpegCloud cloud;
  for (std::size_t slot = 0; slot < map.size(); ++slot) {
    cloud.positions.push_back(map.index.points.offset(slot));
    cloud.rgb.push_back(to_rgb8(color_at(map.colors, slot)));
  }
  return cloud;
}

Record mpeg_direction(const MpegDirection& d) {
  Record record;
  record.add("point_mse", d.point_mse_m2).add("hausdorff_squared", d.sq_hausdorff_m2);
  record.add("color_mse", std::vector<double>(d.color_mse.begin(), d.color_mse.end()));
  return record.add("color_psnr", std::vector<double>(d.color_psnr_db.begin(), d.color_psnr_db.end()));
}

Record mpeg_record(MetricInputs& inputs, const PeerOptions&) {
  const MpegDistortion d = mpeg_distortion(mpeg_cloud(inputs.pair->reference), mpeg_cloud(inputs.estimate));
  Record record;
  record.add("definition", "mpeg-pcc-dmetric 0.14 pc_error, point to point and color (BT.709, peak 1)");
  record.add("reference_to_estimate", mpeg_direction(d.reference_to_estimate));
  record.add("estimate_to_reference", mpeg_direction(d.estimate_to_reference));
  return record.add("symmetric", mpeg_direction(d.symmetric));
}

}  // namespace

namespace peers {

extern constinit const PeerTool mpeg{
    .name = "mpeg",
    .record = mpeg_record,
    .no_color_id = "mpeg_needs_color",
    .no_color = "pc_error's color numbers need a color at every point of both maps: null"};

}  // namespace peers
}  // namespace cmap
