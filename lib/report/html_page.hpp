#pragma once

#include <string_view>

namespace cmap {

/// The page of reports, built from lib/report/web and compiled in; its data belongs where kHtmlDataPlace stands.
std::string_view html_page();

inline constexpr std::string_view kHtmlDataPlace = "<!--CMAP_DATA-->";

}  // namespace cmap
