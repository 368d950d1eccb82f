#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "bytes/file_start.hpp"

namespace cmap {

/// What a file is that holds no points for us, by its content: "is an E57 file (...)", with the way out where there is
/// one. Empty if nothing is known of it.
std::optional<std::string> foreign_content(const FileStart& start);

/// The same by the extension of its name, for formats without a mark in their content, or whose mark is missing.
std::optional<std::string> foreign_extension(const FileStart& start);

/// What files of Gaussian splats are, whatever their format, and how they become points.
std::string_view splat_hint();

}  // namespace cmap
