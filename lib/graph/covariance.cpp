#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <stdexcept>

#include "cmap/core/error.hpp"
#include "cmap/graph/pose_graph.hpp"
#include "link_error.hpp"

namespace cmap {
namespace {

using graph::Link;
using graph::NodeGraph;

/// H = sum rho' J^T information J over the free nodes, and its factors.
template <int kDim>
class Information {
 public:
  using Block = Eigen::Matrix<double, kDim, kDim>;

  explicit Information(const NodeGraph& graph) : slot_(graph.nodes.size(), -1) {
    int size = 0;
    for (std::size_t i = 0; i < slot_.size(); ++i) {
      if (graph.is_fixed[i]) continue;
      slot_[i] = size;
      size += kDim;
    }
    for (const Link& link : graph.links) add(graph, link);
    H_.resize(size, size);
    H_.setFromTriplets(entries_.begin(), entries_.end());
    if (size > 0) factorize();
  }

  /// The diagonal block of the inverse at a node.
  Block covariance(std::size_t node) const {
    const int slot = slot_[node];
    if (slot < 0) return Block::Zero();
    Eigen::Matrix<double, Eigen::Dynamic, kDim> unit;
    unit.setZero(H_.rows(), kDim);
    for (int c = 0; c < kDim; ++c) unit(slot + c, c) = unit_[slot + c];
    const Block half = factor_.solve(unit).template middleRows<kDim>(slot);
    const Block block = unit_.segment<kDim>(slot).asDiagonal() * half;
    return 0.5 * (block + block.transpose());
  }

 private:
  void add(const NodeGraph& graph, const Link& link) {
    const graph::LinkError error =
        graph::link_error(graph::from_node(graph, link), graph.nodes[link.to], link.relative);
    const Block U = link.sqrt_information.topLeftCorner<kDim, kDim>();
    const double weight = graph::robust_slope((U * error.r.head<kDim>()).squaredNorm(), link.cauchy_width);
    const Block from = std::sqrt(weight) * U * error.by_from.topLeftCorner<kDim, kDim>();
    const Block to = std::sqrt(weight) * U * error.by_to.topLeftCorner<kDim, kDim>();
    const int i = link.from == graph::kWorld ? -1 : slot_[link.from], j = slot_[link.to];
    if (i >= 0) add_block(i, i, from.transpose() * from);
    if (j >= 0) add_block(j, j, to.transpose() * to);
    if (i >= 0 && j >= 0) {
      add_block(i, j, from.transpose() * to);
      add_block(j, i, to.transpose() * from);
    }
  }
  void add_block(int row, int column, const Block& block) {
    for (int r = 0; r < kDim; ++r) {
      for (int c = 0; c < kDim; ++c) entries_.emplace_back(row + r, column + c, block(r, c));
    }
  }
  /// Meters, radians and scales are brought to one measure first: each by what is known of it alone.
  void factorize() {
    const Eigen::VectorXd diagonal = H_.diagonal();
    unit_ = diagonal.cwiseMax(0.0).cwiseSqrt().cwiseInverse();
    bool held = unit_.allFinite();
    if (held) {
      factor_.compute(unit_.asDiagonal() * H_ * unit_.asDiagonal());
      constexpr double kSingular = 1e-13;  // pivots of a free direction are rounding: below 1e-15 times the fill
      held = factor_.info() == Eigen::Success && factor_.vectorD().minCoeff() > kSingular;
    }
    if (!held)
      throw UnsupportedError("the measurements of the pose graph leave something free: there is no covariance");
  }

  std::vector<int> slot_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::SparseMatrix<double> H_;
  Eigen::VectorXd unit_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

template <class Pose, int kDim>
std::vector<Eigen::Matrix<double, kDim, kDim>> covariances(const Graph<Pose, kDim>& graph, std::span<const Pose> poses,
                                                           std::span<const std::size_t> nodes) {
  for (const std::size_t node : nodes) {
    if (node >= graph.poses.size()) {
      throw std::invalid_argument(fmt::format("pose graph: the covariance of node {} of {}", node, graph.poses.size()));
    }
  }
  const Information<kDim> information(graph::node_graph(graph, poses));
  std::vector<Eigen::Matrix<double, kDim, kDim>> result;
  for (const std::size_t node : nodes) result.push_back(information.covariance(node));
  return result;
}

}  // namespace

std::vector<PoseGraph::Information> node_covariances(const PoseGraph& graph, std::span<const Eigen::Isometry3d> poses,
                                                     std::span<const std::size_t> nodes) {
  return covariances(graph, poses, nodes);
}

std::vector<ScaledPoseGraph::Information> node_covariances(const ScaledPoseGraph& graph,
                                                           std::span<const Similarity> poses,
                                                           std::span<const std::size_t> nodes) {
  return covariances(graph, poses, nodes);
}

}  // namespace cmap
