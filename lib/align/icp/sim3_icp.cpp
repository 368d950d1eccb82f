#include "cmap/align/sim3_icp.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "cmap/align/umeyama.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/voxel_map.hpp"
#include "icp/registration_cloud.hpp"
#include "icp/require.hpp"

namespace cmap {
namespace {

/// first (last / first)^f; zeros stay zero.
double annealed(double first, double last, double f) {
  if (first == last || first <= 0.0) return f < 1.0 ? first : last;
  return first * std::pow(last / first, f);
}

/// Mean weight per voxel, in the order of voxel_thinned(), relative to the mean of all.
Array<float> thinned_weights(const PointCloud& cloud, std::span<const float> weights, double voxel_m,
                             std::size_t n_thinned) {
  if (weights.empty()) return Array<float>(n_thinned, 1.0f);
  if (weights.size() != cloud.size()) throw std::invalid_argument("sim3_icp: one weight per source point is needed");
  for (const float w : weights) {
    if (!(w >= 0.0f) || !std::isfinite(w))
      throw std::invalid_argument("sim3_icp: weights must be finite, not negative");
  }
  const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
  if (!(mean > 0.0)) throw std::invalid_argument("sim3_icp: all weights are zero");
  if (!(voxel_m > 0.0)) {
    Array<float> relative(weights.begin(), weights.end());
    for (float& w : relative) w = static_cast<float>(w / mean);
    return relative;
  }
  struct Sum {
    double weight = 0.0;
    std::size_t n = 0;
  };
  VoxelMap<Sum> sums;
  const VoxelFrame frame(bounds(cloud), voxel_m);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Sum& sum = sums[frame.key(cloud.world(i))];
    sum.weight += weights[i];
    ++sum.n;
  }
  Array<float> means;
  for (const auto& [key, sum] : sums.entries()) {
    means.push_back(static_cast<float>(sum.weight / (mean * static_cast<double>(sum.n))));
  }
  return means;
}

/// The part of space that the target saw: its box, and its occupied cells. Offsets from the target's origin.
class SeenSpace {
 public:
  SeenSpace(const PointCloud& target, double cell_m) : box_(local_box(target)), frame_(box_, cell_m) {
    for (const Eigen::Vector3f& p : target.positions) cells_[frame_.key(p.cast<double>())] = true;
  }
  bool contains(const Eigen::Vector3d& p) const {
    if ((p.array() < box_.min.array()).any() || (p.array() > box_.max.array()).any()) return false;
    return cells_.find(frame_.key(p)) != nullptr;
  }

 private:
  static Box3d local_box(const PointCloud& cloud) {
    const Box3d box = bounds(cloud);
    return {box.min - cloud.origin, box.max - cloud.origin};
  }
  Box3d box_;
  VoxelFrame frame_;
  VoxelMap<bool> cells_;
};

class Sim3Registration {
 public:
  Sim3Registration(const PointCloud& source, const PointCloud& target, double initial_scale,
                   const Sim3IcpOptions& options, std::span<const float> weights)
      : options_(options),
        thinned_source_(thinned_to(source, options.voxel_m / initial_scale)),
        thinned_target_(thinned_target(target, options.voxel_m)),
        source_(thinned_source_),
        target_(thinned_target_, static_cast<std::size_t>(options.neighbors)),
        seen_(thinned_target_, options.voxel_m > 0.0 ? options.crop_cell * options.voxel_m : options.gate1_m),
        weights_(thinned_weights(source, weights, options.voxel_m / initial_scale, thinned_source_.size())),
        s0_(initial_scale) {}

  /// Iterates from a local transform. Throws UnsupportedError where the matches determine nothing.
  Similarity run(Similarity local, Alignment& result) {
    const double lambda_per_beta = static_cast<double>(source_.size()) * sq_size();
    const double unit_m = std::min(options_.gate1_m, 1.0);
    const StepLimits limits{1e-5, 1e-4 * unit_m, 1e-6};
    for (int k = 0; k < options_.iterations && !result.converged; ++k) {
      const double f = std::min(1.0, static_cast<double>(k) / std::max(1, options_.annealed_iterations));
      gate_m_ = annealed(options_.gate0_m, options_.gate1_m, f);
      field_ = source_.nearest(target_.index, local);
      const PairMoments moments = matched_moments(local);
      if (moments.n < 3) fail_no_overlap(moments.n, gate_m_);
      const ScaleModel scale{true, s0_, annealed(options_.beta0, options_.beta1, f) * lambda_per_beta};
      const Similarity next = fit_similarity(moments, scale);
      result.converged = k >= options_.annealed_iterations && limits.hold(local, next, source_.center());
      local = next;
      ++result.iterations;
    }
    result.voxel_m = options_.voxel_m;
    result.max_distance_m = gate_m_;
    return local;
  }

  void assess_at(const Similarity& local, Alignment& result) {
    assess(source_, target_, local, options_.gate1_m, true, result);
  }

 private:
  PairMoments matched_moments(const Similarity& local) const {
    const double sq_gate = gate_m_ * gate_m_;
    return pair_moments(source_.size(), [&](std::size_t slot) {
      WeightedPair pair{source_.points().offset(slot).cast<double>(),
                        target_.index.points.offset(field_.slot[slot]).cast<double>(), 0.0};
      if (!(field_.sq_dist[slot] <= sq_gate)) return pair;
      if (options_.crop && !seen_.contains(local * pair.p)) return pair;
      pair.weight = static_cast<double>(weights_[source_.points().original_index[slot]]) *
                    robust_weight(options_.kernel, std::sqrt(field_.sq_dist[slot]), options_.kernel_width * gate_m_);
      return pair;
    });
  }

  /// D^2 in the source's units.
  double sq_size() const {
    if (options_.size_from_box) {
      const Box3d box = bounds(thinned_source_);
      return (box.max - box.min).squaredNorm();
    }
    const PairMoments all = pair_moments(source_.size(), [&](std::size_t slot) {
      const Eigen::Vector3d p = source_.points().offset(slot).cast<double>();
      return WeightedPair{p, p, 1.0};
    });
    return 12.0 * all.scatter_p.trace() / all.weight;
  }

  const Sim3IcpOptions& options_;
  PointCloud thinned_source_, thinned_target_;
  MovingSource source_;
  RegistrationTarget target_;
  SeenSpace seen_;
  Array<float> weights_;  ///< by point of the thinned source
  double s0_;
  double gate_m_ = 0.0;
  NearestField field_;
};

/// Why a result cannot be used; empty: it can.
std::string refusal(const Sim3Alignment& result, const Sim3IcpOptions& options) {
  if (result.n_matches < options.min_matches) {
    return fmt::format("{} matches; {} are needed", result.n_matches, options.min_matches);
  }
  if (result.overlap < options.min_overlap) {
    return fmt::format("overlap {:.3g}; {:g} is needed", result.overlap, options.min_overlap);
  }
  return {};
}

}  // namespace

Sim3IcpOptions Sim3IcpOptions::robust(double voxel_m, double sigma_m) {
  Sim3IcpOptions options;
  options.voxel_m = voxel_m;
  options.gate0_m = std::max(10.0 * voxel_m, 3.0 * sigma_m);
  options.gate1_m = 3.0 * voxel_m;
  return options;
}

Sim3IcpOptions Sim3IcpOptions::paper(double voxel_m) {
  Sim3IcpOptions options;
  options.voxel_m = voxel_m;
  options.beta0 = options.beta1 = 0.1;
  options.gate0_m = options.gate1_m = 10.0 * voxel_m;
  options.crop = false;
  options.kernel = RobustKernel::kNone;
  options.size_from_box = true;
  options.annealed_iterations = 0;
  return options;
}

Sim3IcpOptions Sim3IcpOptions::normal(double voxel_m) {
  Sim3IcpOptions options = paper(voxel_m);
  options.beta0 = options.beta1 = 0.0;
  return options;
}

void check_options(const Sim3IcpOptions& o) {
  require(o.voxel_m >= 0.0 && std::isfinite(o.voxel_m), "voxel_m", o.voxel_m, "0 or more is needed");
  require(o.beta0 >= 0.0 && std::isfinite(o.beta0), "beta0", o.beta0, "0 or more is needed");
  require(o.beta1 >= 0.0 && o.beta1 <= o.beta0, "beta1", o.beta1, "0 or more is needed, at most beta0");
  require((o.beta0 > 0.0) == (o.beta1 > 0.0), "beta1", o.beta1, "both betas are 0, or none");
  require(o.gate1_m > 0.0, "gate1_m", o.gate1_m, "a distance above 0 is needed");
  require(o.gate0_m >= o.gate1_m, "gate0_m", o.gate0_m, "at least gate1_m is needed");
  require(std::isfinite(o.gate0_m) || o.gate1_m == o.gate0_m, "gate1_m", o.gate1_m, "an endless gate cannot shrink");
  require(std::isfinite(o.gate0_m) || o.kernel == RobustKernel::kNone, "gate0_m", o.gate0_m,
          "an endless gate gives the kernel no width");
  require(o.crop_cell > 0.0 && std::isfinite(o.crop_cell), "crop_cell", o.crop_cell, "a size above 0 is needed");
  require(o.kernel_width > 0.0, "kernel_width", o.kernel_width, "a share above 0 is needed");
  require(o.iterations > 0, "iterations", o.iterations, "at least 1 is needed");
  require(o.annealed_iterations >= 0, "annealed_iterations", o.annealed_iterations, "0 or more are needed");
  require(o.neighbors >= 5 && o.neighbors <= 64, "neighbors", o.neighbors, "5 to 64 are possible");
}

Sim3Alignment sim3_icp(const PointCloud& source, const PointCloud& target, const Eigen::Matrix4d& T_initial,
                       const Sim3IcpOptions& options, std::span<const float> weights) {
  check_options(options);
  const Similarity initial = similarity_from(T_initial);
  Sim3Registration registration(source, target, initial.scale, options, weights);
  Sim3Alignment result;
  result.method = "sim3";
  result.T_dst_src = initial.matrix();
  result.scale = initial.scale;
  std::string why;
  try {
    const Similarity local = registration.run(local_transform(initial, source.origin, target.origin), result);
    registration.assess_at(local, result);
    why = refusal(result, options);
    if (why.empty()) {
      result.T_dst_src = world_transform(local, source.origin, target.origin).matrix();
      result.scale = local.scale;
    }
  } catch (const UnsupportedError& error) {
    why = error.what();
  }
  result.accepted = why.empty();
  const double ratio = result.scale / initial.scale;
  if (!(ratio >= options.min_scale && ratio <= options.max_scale)) {
    result.warnings.push_back(fmt::format("the scale changed by a factor of {:.4g}, outside [{:g}, {:g}]", ratio,
                                          options.min_scale, options.max_scale));
  }
  if (!result.accepted) result.warnings.push_back("the initial transform is kept: " + why);
  return result;
}

}  // namespace cmap
