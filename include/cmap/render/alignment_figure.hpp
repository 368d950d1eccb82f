#pragma once

#include <filesystem>

#include "cmap/align/alignment.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/output_file.hpp"
#include "cmap/render/image.hpp"

namespace cmap {

/// Two maps and what was found of them.
struct AlignmentPicture {
  const PointCloud& source;
  const PointCloud& target;
  Eigen::Matrix4d T_initial;  ///< dst from src, from which the alignment started
  const Alignment& alignment;
};

/// Both maps from above before and after, the distances of the source's points to the target, and, where there is
/// another answer, the best of those. Of each map at most about 500,000 points. A source that lay outside the picture
/// is moved into it for the first panel, which says so. The same bytes for any number of threads.
Image draw_alignment(const AlignmentPicture& picture);

/// Throws UsageError where `name` is no picture's.
void write_alignment_figure(const AlignmentPicture& picture, const std::filesystem::path& name, OutputFile& file);

}  // namespace cmap
