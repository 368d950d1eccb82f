#pragma once

#include <string_view>

namespace cmap {

/// A text without UTF-8's byte order mark, which Windows programs write before it.
inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

/// Whether a text starts as UTF-16 does (PowerShell's redirection); nothing here reads it.
inline bool starts_as_utf16(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

}  // namespace cmap
