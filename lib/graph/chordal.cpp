#include "chordal.hpp"

#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "cmap/core/error.hpp"
#include "cmap/geometry/rotation.hpp"

namespace cmap::graph {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Linear least squares over the free nodes: sum w |y_j - A^T y_i - b|^2, y of kRows rows for every node.
template <int kRows, int kColumns>
class NodeLeastSquares {
 public:
  using Value = Eigen::Matrix<double, kRows, kColumns>;
  using Map = Eigen::Matrix<double, kRows, kRows>;

  explicit NodeLeastSquares(const NodeGraph& graph) : slot_(graph.nodes.size(), -1) {
    for (std::size_t i = 0; i < slot_.size(); ++i) {
      if (!graph.is_fixed[i]) slot_[i] = kRows * n_free_++;
    }
    right_.setZero(kRows * n_free_, kColumns);
  }

  /// `from_value` counts where the node is fixed or the world.
  void add(const Link& link, double weight, const Map& A, const Value& b, const Value& from_value,
           const Value& to_value) {
    const int i = link.from == kWorld ? -1 : slot_[link.from], j = slot_[link.to];
    if (i >= 0) add_block(i, i, weight * A * A.transpose());
    if (j >= 0) add_block(j, j, weight * Map::Identity());
    if (i >= 0 && j >= 0) {
      add_block(i, j, -weight * A);
      add_block(j, i, -weight * A.transpose());
    }
    const Value to = j >= 0 ? Value(Value::Zero()) : to_value;
    const Value from = i >= 0 ? Value(Value::Zero()) : from_value;
    if (i >= 0) right_.template middleRows<kRows>(i) += weight * A * (to - b);
    if (j >= 0) right_.template middleRows<kRows>(j) += weight * (A.transpose() * from + b);
  }

  void solve(const char* what) {
    const int size = kRows * n_free_;
    Sparse H(size, size);
    H.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Sparse> factor(H);
    constexpr double kSingular = 1e-12;  // of the largest pivot: rounding
    const bool held = factor.info() == Eigen::Success && factor.vectorD().allFinite() &&
                      factor.vectorD().minCoeff() > kSingular * factor.vectorD().maxCoeff();
    if (!held)
      throw UnsupportedError(std::string("the information of the pose graph leaves a node's ") + what + " free");
    solution_ = factor.solve(right_);
  }
  /// The solution of a free node.
  Value of(std::size_t node) const { return solution_.template middleRows<kRows>(slot_[node]); }

 private:
  void add_block(int row, int column, const Map& block) {
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kRows; ++c) entries_.emplace_back(row + r, column + c, block(r, c));
    }
  }
  std::vector<int> slot_;
  int n_free_ = 0;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::Matrix<double, Eigen::Dynamic, kColumns> right_, solution_;
};

Node from_or_world(const NodeGraph& graph, const Link& link) {
  return link.from == kWorld ? Node{} : graph.nodes[link.from];
}

/// log s_j = log s_i + log s_ij
void solve_scales(NodeGraph& graph) {
  using Scalar = Eigen::Matrix<double, 1, 1>;
  NodeLeastSquares<1, 1> system(graph);
  for (const Link& link : graph.links) {
    system.add(link, link.mean_information[2], Scalar::Ones(), Scalar(link.relative.log_scale),
               Scalar(from_or_world(graph, link).log_scale), Scalar(graph.nodes[link.to].log_scale));
  }
  system.solve("scale");
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    if (!graph.is_fixed[i]) graph.nodes[i].log_scale = system.of(i)[0];
  }
}

/// R_j = R_i R_ij, transposed: R_j^T = R_ij^T R_i^T; the nine numbers are three columns with one matrix.
void solve_rotations(NodeGraph& graph) {
  NodeLeastSquares<3, 3> system(graph);
  for (const Link& link : graph.links) {
    system.add(link, link.mean_information[1], link.relative.rotation.toRotationMatrix(), Eigen::Matrix3d::Zero(),
               from_or_world(graph, link).rotation.conjugate().toRotationMatrix(),
               graph.nodes[link.to].rotation.conjugate().toRotationMatrix());
  }
  system.solve("rotation");
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    if (!graph.is_fixed[i])
      graph.nodes[i].rotation = Eigen::Quaterniond(nearest_rotation(system.of(i).transpose())).normalized();
  }
}

/// t_j = t_i + s_i R_i t_ij; one equation for the three axes.
void solve_translations(NodeGraph& graph) {
  NodeLeastSquares<1, 3> system(graph);
  using One = Eigen::Matrix<double, 1, 1>;
  for (const Link& link : graph.links) {
    const Node from = from_or_world(graph, link);
    // The edge is measured in the units of its first node.
    const double unit = std::exp(from.log_scale);
    const Eigen::Vector3d step = unit * (from.rotation * link.relative.translation);
    system.add(link, link.mean_information[0] / (unit * unit), One::Ones(), step.transpose(),
               from.translation.transpose(), graph.nodes[link.to].translation.transpose());
  }
  system.solve("position");
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    if (!graph.is_fixed[i]) graph.nodes[i].translation = system.of(i).transpose();
  }
}

}  // namespace

void start_from_chordal(NodeGraph& graph) {
  bool all_fixed = true;
  for (const char fixed : graph.is_fixed) all_fixed = all_fixed && fixed;
  if (all_fixed) return;
  if (graph.dim == 7) solve_scales(graph);
  solve_rotations(graph);
  solve_translations(graph);
}

}  // namespace cmap::graph
