#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cmap/core/execution.hpp"
#include "cmap/core/warning.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/capture.hpp"
#include "cmap/recon/options.hpp"

namespace cmap {

enum class Stage { kPrefusion, kRegistration, kPoseGraph, kFusion };

/// "prefusion", "registration", "posegraph" or "fusion".
std::string_view stage_name(Stage stage);

/// What became of one session.
struct SessionOutcome {
  std::size_t index = 0;  ///< of the capture's sessions
  std::string name;
  std::size_t frames = 0;
  double scale_prefusion = 0.0;                                          ///< s1 after voting
  double scale_registration = 1.0;                                       ///< s2
  double scale() const { return scale_prefusion * scale_registration; }  ///< meters in the session's unit
  double linearity = 0.0;
  bool rotation_corrected = false;
  bool scale_inlier = true;
  double prefusion_rmse_m = 0.0;       ///< of its camera centers
  double overlap = 0.0;                ///< with the LiDAR; NaN: not measured, as there are no scans
  double rmse_m = 0.0;                 ///< of these matches; likewise
  std::vector<std::string> flags;      ///< doubts, for people
  std::optional<std::string> dropped;  ///< why it is not in the map; none: it is
};

/// What the pose graph did.
struct GraphSummary {
  double cost_before = 0.0, cost_after = 0.0;
  int iterations = 0;
  double largest_correction_m = 0.0;  ///< of a camera
};

/// Some of a session's points, for pictures: each in its frame's camera, in the session's unit.
struct SessionSketch {
  Array<Eigen::Vector3f> positions;
  std::vector<std::uint32_t> frame;
};

/// What a reconstruction found, as far as it was asked to go.
struct Reconstruction {
  std::vector<SessionOutcome> sessions;
  std::vector<PlacedSession> prefusion, registration, poses;  ///< of the sessions in the map, after each stage
  std::vector<SessionLink> links;
  GraphSummary graph;
  PointCloud map;
  std::uint64_t points_fused = 0;
  std::vector<SessionSketch> sketches;  ///< of the sessions in the map, where it was fused
  Trajectory trajectory;                ///< world_T_imu at the frames' times
  std::vector<Warning> warnings;
  std::vector<std::pair<Stage, double>> stage_seconds;
};

struct ReconstructionRun {
  Stage last = Stage::kFusion;
  std::optional<std::size_t> only_session;
  std::filesystem::path stages;  ///< folder of what earlier runs found and this one finds; empty: none
  bool resume = false;           ///< take from there what was found from the same inputs and options
  Execution execution = {};
  /// Gets each session's own map, fused as the whole is, as soon as it is there; empty: nobody wants them.
  std::function<void(const std::string& session, const PointCloud& map)> session_map;
};

/// What a run up to a stage reads of a capture: no pictures, as predictions hold their pixels; scans only where they
/// are registered on. With pre-fusion alone they measure how well it fits, and may be missing.
CaptureParts parts_needed(const ReconstructionOptions& options, Stage last);

/// Sessions of VGGT predictions, LiDAR scans and LiDAR-inertial poses become one metric colored map: pre-fusion,
/// registration, pose graph, fusion (PIPELINE). One session is in memory at a time, two for their links; the fused map
/// bounds the rest. The same bytes for any number of threads.
/// A session that cannot be read or placed is dropped, with the reason in its outcome and a warning. Throws InputError
/// where the capture has no sessions, no LiDAR-inertial poses or no scans that are needed, UnsupportedError where fewer
/// than half of the sessions are left.
Reconstruction reconstruct(const Capture& capture, const ReconstructionOptions& options,
                           const ReconstructionRun& run = {});

}  // namespace cmap
