#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cmap/recon/lidar_map.hpp"
#include "cmap/recon/post_fusion.hpp"
#include "cmap/recon/pre_fusion.hpp"
#include "cmap/recon/session_points.hpp"

namespace cmap {

/// How the scales of neighboring sessions are compared.
enum class OverlapScale {
  kDepths,   ///< by the depths of the same pixels
  kCenters,  ///< the paper's: by the camera centers of shared frames
};

/// Everything that can change the map of a reconstruction (PIPELINE). Defaults are the sound version; the preset
/// "paper" is the text as printed.
struct ReconstructionOptions {
  PointSource points = PointSource::kDepth;
  ConfidenceCut confidence;
  PreFusionOptions prefusion;
  OverlapScale overlap_scale = OverlapScale::kDepths;
  Registration registration = Registration::kRobust;
  double registration_voxel_m = 0.2;
  LidarMapOptions lidar;
  bool pose_graph = true;  ///< false: sessions stay where registration has put them
  bool lidar_priors = true;
  double fusion_voxel_m = 0.05;
  double fusion_max_range_m = 0.0;  ///< points farther from their camera are left out of the map; 0: none
  double fusion_doubt = 0.5;  ///< voxels less sure than this share of what lies around them are left out; see MapFusion
};

/// Sets the options that a JSON object names (comments allowed). Throws UsageError naming `source` and the key:
/// unknown, wrong type, out of range.
void apply_reconstruction_config(ReconstructionOptions& options, const std::string& json_text,
                                 const std::string& source);
void apply_reconstruction_config_file(ReconstructionOptions& options, const std::filesystem::path& path);

/// Sets one option from a command line: "registration_voxel_m=0.5".
void set_reconstruction_option(ReconstructionOptions& options, const std::string& assignment);

/// "default" or "paper". Throws UsageError for anything else.
void apply_reconstruction_preset(ReconstructionOptions& options, const std::string& name);

/// All options by their names in PIPELINE.
nlohmann::ordered_json to_json(const ReconstructionOptions& options);

}  // namespace cmap
