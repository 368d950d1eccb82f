#pragma once

#include "node_graph.hpp"

namespace cmap::graph {

/// Moves all nodes but the fixed ones as chordal_poses() says.
void start_from_chordal(NodeGraph& graph);

}  // namespace cmap::graph
