#include "cmap/peers/peer_tool.hpp"

namespace cmap {

const EnumNames<const PeerTool*>& peer_tool_names() {
  static const EnumNames<const PeerTool*> names = [] {
    EnumNames<const PeerTool*> all;
    for (const PeerTool* tool : peer_tools()) all.emplace_back(tool, tool->name);
    return all;
  }();
  return names;
}

const PeerTool* peer_tool(std::string_view name) {
  for (const PeerTool* tool : peer_tools()) {
    if (tool->name == name) return tool;
  }
  return nullptr;
}

}  // namespace cmap
