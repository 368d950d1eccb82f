#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cmap/geometry/similarity.hpp"

namespace cmap {

/// Poses of nodes in one world, and what was measured between them. kDim: degrees of freedom of a node.
///
/// The cost is the sum over edges and priors of rho(r^T information r), without a factor 1/2, where an edge has
///   r = [ R_i^T (t_j - t_i) / s_i - t_ij ; Log(R_ij^T R_i^T R_j) ; log s_j - log s_i - log s_ij ]
/// with i = from, j = to, in the axes of node i and the order (x y z | rx ry rz | log scale), meters and radians. SE(3)
/// graphs have s = 1 and no last row. Sim(3) translations are in the units of node i.
/// rho is the identity, or rho(x) = c^2 log(1 + x / c^2) where `cauchy_width` c > 0 (in standard deviations).
template <class Pose, int kDim>
struct Graph {
  using Information = Eigen::Matrix<double, kDim, kDim>;

  struct Edge {
    std::size_t from = 0, to = 0;
    Pose T_from_to{};  ///< pose of `to` in the frame of `from`
    Information information = Information::Identity();
    double cauchy_width = 0.0;
  };
  /// What is known of one node by itself: an edge from the world's own frame.
  struct Prior {
    std::size_t node = 0;
    Pose T_world_node{};
    Information information = Information::Identity();
    double cauchy_width = 0.0;
  };

  std::vector<Pose> poses;  ///< T_world_node: where the nodes are, or start
  std::vector<Edge> edges;
  std::vector<Prior> priors;
  std::vector<std::size_t> fixed{0};  ///< nodes that stay where they are; may be empty where priors hold the graph
};

using PoseGraph = Graph<Eigen::Isometry3d, 6>;  ///< SE(3)
using ScaledPoseGraph = Graph<Similarity, 7>;   ///< Sim(3)

/// Where an optimization starts.
enum class GraphStart {
  kPoses,    ///< the graph's own poses
  kChordal,  ///< chordal_poses()
  kLower,    ///< whichever of the two costs less before the first step
  kBoth,     ///< from both, side by side; the lower final cost is kept
};

struct GraphOptions {
  GraphStart start = GraphStart::kLower;
  int max_iterations = 100;           ///< Levenberg-Marquardt steps of one start
  double function_tolerance = 1e-10;  ///< ends when a step lowers the cost by less, relatively
};

template <class Pose>
struct GraphResult {
  std::vector<Pose> poses;
  double initial_cost = 0.0;  ///< of the graph's own poses
  double start_cost = 0.0;    ///< of the poses that the kept run began with
  double final_cost = 0.0;
  int iterations = 0;              ///< of the kept run
  bool converged = false;          ///< the kept run ended before max_iterations
  bool chordal_start = false;      ///< the kept run began with chordal_poses()
  std::vector<double> edge_costs;  ///< r^T information r of every edge at the result, before rho
  std::vector<std::string> warnings;
};
using PoseGraphResult = GraphResult<Eigen::Isometry3d>;
using ScaledPoseGraphResult = GraphResult<Similarity>;

/// Minimizes the cost with Levenberg-Marquardt (Ceres; sparse Cholesky factors by Eigen on one thread, so that the
/// result is the same for any number of threads and any BLAS). Thread-safe.
/// Throws std::invalid_argument where the graph is malformed: no such node, an edge from a node to itself, a pose,
/// information or width that is not finite, information that is not symmetric positive semidefinite, a scale that is
/// not positive; UnsupportedError where a node is connected to no fixed node and no prior, naming it; UsageError for
/// options.
PoseGraphResult optimize(const PoseGraph& graph, const GraphOptions& options = {});
ScaledPoseGraphResult optimize(const ScaledPoseGraph& graph, const GraphOptions& options = {});

/// The cost of the graph's edges and priors with its nodes at `poses`. Throws as optimize().
double graph_cost(const PoseGraph& graph, std::span<const Eigen::Isometry3d> poses);
double graph_cost(const ScaledPoseGraph& graph, std::span<const Similarity> poses);

/// Poses from linear least squares, whatever the graph's own poses are (those of fixed nodes excepted): scales from
/// log s_j - log s_i = log s_ij, rotations from R_j = R_i R_ij in nine numbers each, made rotations afterwards
/// (Martinec and Pajdla 2007, Carlone et al. 2015), then positions from t_j = t_i + s_i R_i t_ij. Every block of an
/// edge weighs as much as the mean of its information's diagonal; widths are ignored. Throws as optimize(), and
/// UnsupportedError where the information leaves a node free.
std::vector<Eigen::Isometry3d> chordal_poses(const PoseGraph& graph);
std::vector<Similarity> chordal_poses(const ScaledPoseGraph& graph);

/// Covariances of nodes at `poses`, the inverse of the Gauss-Newton information (edges with a width count by their
/// weight rho'): of the error d in R_true = R Exp(d_r), t_true = t + d_t (world axes), log s_true = log s + d_s, in the
/// order (x y z | rx ry rz | log scale). Zero for fixed nodes. Throws as optimize(), and UnsupportedError where the
/// measurements leave something free.
std::vector<PoseGraph::Information> node_covariances(const PoseGraph& graph, std::span<const Eigen::Isometry3d> poses,
                                                     std::span<const std::size_t> nodes);
std::vector<ScaledPoseGraph::Information> node_covariances(const ScaledPoseGraph& graph,
                                                           std::span<const Similarity> poses,
                                                           std::span<const std::size_t> nodes);

}  // namespace cmap
