#pragma once

#include <string>

#include "clouds/color_store.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// What a report calls the scale of colors that were read as declared: "0 to 255", "16 bit", ...; `white` is what
/// floats were divided by.
std::string color_scale_text(const Colors& colors, float white, const ColorDeclaration& declaration);

/// What was decided where the declaration leaves it open; empty where it does not.
std::string color_scale_note(const Colors& colors, float white, const ColorDeclaration& declaration);

/// The numbers of a file as they were stored.
struct StoredColors {
  float highest = 0.0F;
  float white = 0.0F;      ///< of floats; 0: the type says it
  std::uint32_t bits = 0;  ///< that any of the whole numbers has
};

/// Warns of colors that can hardly be what was meant: none brighter than a small share of the range, some far brighter
/// than all others (another scale), a large share of exactly one color. Sets info.gray_colors.
void warn_of_odd_colors(const Colors& colors, const StoredColors& stored, FileInfo& info);

}  // namespace cmap
