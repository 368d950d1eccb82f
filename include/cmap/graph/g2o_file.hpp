#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cmap/graph/pose_graph.hpp"

namespace cmap {

/// A pose graph as a g2o text file holds it.
struct G2oGraph {
  PoseGraph graph;                 ///< nodes by increasing id
  std::vector<std::uint64_t> ids;  ///< of the nodes
  std::vector<std::string> notes;  ///< what was missing or passed over
};

/// Reads VERTEX_SE3:QUAT, EDGE_SE3:QUAT (21 numbers of information, the upper triangle by rows, order x y z rx ry rz)
/// and FIX; `#` comments and PARAMS_ lines are passed over. Quaternions are normalized. Without FIX the lowest id is
/// fixed. Nodes without a vertex line are placed along edges from those that have one, breadth first; the lowest id of
/// a piece without any at the origin. g2o itself weighs rotations by the vector part of the quaternion, which is half
/// the angle: its costs are not these. Throws InputError naming file, line and reason: another tag, too few or too many
/// numbers, a number that is none or not finite, a quaternion of zero, a vertex given twice, an edge from a node to
/// itself, information that is not positive semidefinite, FIX of an unknown node, no edge at all.
G2oGraph read_g2o(const std::filesystem::path& path);

/// Writes the same, numbers in their shortest form that reads back equal; `ids` empty: 0, 1, 2 ... Throws
/// UnsupportedError for priors and widths, which the format does not hold, std::invalid_argument where ids are not as
/// many as nodes, OutputError where the file cannot be written.
void write_g2o(const PoseGraph& graph, const std::filesystem::path& path, std::span<const std::uint64_t> ids = {});

}  // namespace cmap
