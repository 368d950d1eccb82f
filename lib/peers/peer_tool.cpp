#include "cmap/peers/peer_tool.hpp"

namespace cmap {

std::vector<std::string> peer_names() {
  std::vector<std::string> names;
  for (const PeerTool* tool : peer_tools()) names.emplace_back(tool->name);
  return names;
}

const PeerTool* peer_tool(std::string_view name) {
  for (const PeerTool* tool : peer_tools()) {
    if (tool->name == name) return tool;
  }
  return nullptr;
}

}  // namespace cmap
