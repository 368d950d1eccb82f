#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "cmap/core/execution.hpp"
#include "cmap/render/camera.hpp"
#include "cmap/render/figure.hpp"

namespace cmap {

/// The camera's positions on a full turn around the vertical axis through its target, the first one where it stands.
std::vector<Camera> turntable_cameras(const Camera& camera, int n_frames);

inline constexpr int kTurntableFramesPerSecond = 24;

/// Throws UsageError unless the name ends in .mp4 or .gif (a video; needs the program ffmpeg) or has no extension (a
/// folder of PNG frames that does not exist yet).
void check_turntable_name(const std::filesystem::path& name);

/// Draws a figure from every camera and writes the video or the folder; it appears when it is complete. The same bytes
/// for any number of threads. Throws OutputError where it cannot be written or ffmpeg
/// fails, UsageError where that is missing.
void write_turntable(std::span<const Layer> layers, std::span<const Camera> cameras, const FigureOptions& options,
                     const std::filesystem::path& name, const Execution& execution = {});

}  // namespace cmap
