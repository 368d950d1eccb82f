#pragma once

#include <filesystem>

#include "cmap/core/execution.hpp"
#include "cmap/sim/capture_options.hpp"

namespace cmap {

/// The scene that the options name. Throws as its maker does.
Scene make_scene(const SceneChoice& choice);

/// The way through it. Throws UsageError where the scene has no such way, or the options give none.
Route make_route(const Scene& scene, const RouteChoice& choice);

/// Simulates a capture into a folder that must not exist: capture.json, images, scans, IMU, poses, predictions, and in
/// truth/ map.ply (points of the surfaces that some picture saw), trajectory.tum (world_T_imu), scales.json (meters per
/// unit of each session, and poses stretched by more than 1), options.json (all of `options`) and preview.png (from
/// above with the way, a picture, its depth, a scan).
/// The folder appears when all is done; the same bytes for the same options at any number of threads. Throws UsageError
/// for options that are out of range or do not fit together, OutputError where the folder cannot be written.
void simulate_capture(const CaptureOptions& options, const std::filesystem::path& folder,
                      const Execution& execution = {});

}  // namespace cmap
