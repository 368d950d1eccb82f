#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cmap {

/// KEYWORD[value, ..., CHILD[...], ...] of well-known text.
struct WktNode {
  std::string keyword;              ///< in capitals
  std::vector<std::string> values;  ///< texts without quotes, numbers, bare words; in order
  std::vector<WktNode> children;    ///< in order

  bool is(std::initializer_list<std::string_view> keywords) const;
  /// The first child of one of these keywords; null if there is none.
  const WktNode* child(std::initializer_list<std::string_view> keywords) const;
};

/// The nodes of a text, one after another; none if it is malformed.
std::optional<std::vector<WktNode>> parse_wkt(std::string_view text);

}  // namespace cmap
