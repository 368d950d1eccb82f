#include "solver.hpp"

#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include <algorithm>
#include <array>

#include "cmap/core/error.hpp"
#include "link_error.hpp"

namespace cmap::graph {
namespace {

using Block = std::array<double, kBlockSize>;

Block block_of(const Node& node) {
  const auto& t = node.translation;
  const auto& q = node.rotation;
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w(), node.log_scale};
}

/// Small motions of a node. The first coordinates of a block stand for the motion, so that cost functions give
/// derivatives by it directly.
class NodeManifold final : public ceres::Manifold {
 public:
  explicit NodeManifold(int dim) : dim_(dim) {}
  int AmbientSize() const override { return kBlockSize; }
  int TangentSize() const override { return dim_; }

  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    Node node = node_at(x);
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> motion(delta);
    node.translation += motion.head<3>();
    node.rotation = (node.rotation * rotation_exp(motion.tail<3>())).normalized();
    if (dim_ == 7) node.log_scale += delta[6];
    const Block block = block_of(node);
    std::copy(block.begin(), block.end(), x_plus_delta);
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    const Node a = node_at(x), b = node_at(y);
    Eigen::Map<Eigen::Matrix<double, 6, 1>> motion(y_minus_x);
    motion << b.translation - a.translation, rotation_log(a.rotation.conjugate() * b.rotation);
    if (dim_ == 7) y_minus_x[6] = b.log_scale - a.log_scale;
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override { return unit(jacobian, kBlockSize, dim_); }
  bool MinusJacobian(const double*, double* jacobian) const override { return unit(jacobian, dim_, kBlockSize); }

 private:
  static bool unit(double* jacobian, int rows, int columns) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobian, rows, columns).setIdentity();
    return true;
  }
  int dim_;
};

/// U r of an edge (kBlocks = 2) or a prior (kBlocks = 1).
template <int kDim, int kBlocks>
class LogCost final : public ceres::CostFunction {
 public:
  explicit LogCost(const Link& link) : link_(link) {
    set_num_residuals(kDim);
    mutable_parameter_block_sizes()->assign(kBlocks, kBlockSize);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Node from = kBlocks == 2 ? node_at(parameters[0]) : Node{};
    const Node to = node_at(parameters[kBlocks - 1]);
    Eigen::Map<Eigen::Matrix<double, kDim, 1>> weighted(residuals);
    const auto U = link_.sqrt_information.topLeftCorner<kDim, kDim>();
    if (jacobians == nullptr) {
      weighted = U * link_residual(from, to, link_.relative).head<kDim>();
      return true;
    }
    const LinkError error = link_error(from, to, link_.relative);
    weighted = U * error.r.head<kDim>();
    if (kBlocks == 2) write(U * error.by_from.topLeftCorner<kDim, kDim>(), jacobians[0]);
    write(U * error.by_to.topLeftCorner<kDim, kDim>(), jacobians[kBlocks - 1]);
    return true;
  }

 private:
  static void write(const Eigen::Matrix<double, kDim, kDim>& derivative, double* jacobian) {
    if (jacobian == nullptr) return;
    Eigen::Map<Eigen::Matrix<double, kDim, kBlockSize, Eigen::RowMajor>> out(jacobian);
    out.setZero();
    out.template leftCols<kDim>() = derivative;
  }
  Link link_;
};

ceres::Solver::Options solver_options(const GraphOptions& options) {
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Eigen's factorization calls no BLAS, and one thread adds in one order: the same bytes everywhere.
  ceres_options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  ceres_options.num_threads = 1;
  // Pose graphs are nearly linear: undamped first steps halve the iterations, and bad ones are taken back.
  ceres_options.initial_trust_region_radius = 1e12;
  ceres_options.max_num_iterations = options.max_iterations;
  ceres_options.function_tolerance = options.function_tolerance;
  ceres_options.gradient_tolerance = 1e-10;
  ceres_options.parameter_tolerance = 1e-10;
  ceres_options.logging_type = ceres::SILENT;
  return ceres_options;
}

}  // namespace

Node node_at(const double* block) {
  return {{block[0], block[1], block[2]}, Eigen::Quaterniond(block[6], block[3], block[4], block[5]), block[7]};
}

std::unique_ptr<ceres::CostFunction> log_cost(const Link& link, int dim) {
  if (link.from == kWorld) {
    if (dim == 6) return std::make_unique<LogCost<6, 1>>(link);
    return std::make_unique<LogCost<7, 1>>(link);
  }
  if (dim == 6) return std::make_unique<LogCost<6, 2>>(link);
  return std::make_unique<LogCost<7, 2>>(link);
}

Outcome solve(NodeGraph& graph, const LinkCost& link_cost, const GraphOptions& options) {
  std::vector<Block> blocks;
  for (const Node& node : graph.nodes) blocks.push_back(block_of(node));
  NodeManifold manifold(graph.dim);
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    problem.AddParameterBlock(blocks[i].data(), kBlockSize, &manifold);
    if (graph.is_fixed[i]) problem.SetParameterBlockConstant(blocks[i].data());
  }
  for (const Link& link : graph.links) {
    ceres::LossFunction* loss = link.cauchy_width > 0.0 ? new ceres::CauchyLoss(link.cauchy_width) : nullptr;
    ceres::CostFunction* cost = link_cost(link).release();
    if (link.from == kWorld) {
      problem.AddResidualBlock(cost, loss, blocks[link.to].data());
    } else {
      problem.AddResidualBlock(cost, loss, blocks[link.from].data(), blocks[link.to].data());
    }
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options), &problem, &summary);
  if (!summary.IsSolutionUsable()) throw UnsupportedError("the pose graph cannot be optimized: " + summary.message);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!graph.is_fixed[i]) graph.nodes[i] = node_at(blocks[i].data());
  }
  const int steps = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  return {2.0 * summary.initial_cost, 2.0 * summary.final_cost, steps, summary.termination_type == ceres::CONVERGENCE};
}

}  // namespace cmap::graph
