#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cmap/core/options.hpp"
#include "cmap/recon/map_fusion.hpp"
#include "cmap/recon/pre_fusion.hpp"
#include "cmap/recon/registration.hpp"
#include "cmap/recon/session_graph.hpp"
#include "cmap/recon/session_input.hpp"

namespace cmap {

/// Everything that can change the map of a reconstruction (PIPELINE), by stage. Defaults are the sound version; the
/// preset "paper" is the text as printed.
struct ReconstructionOptions {
  SessionInputOptions input;  ///< of all stages
  PreFusionOptions prefusion;
  RegistrationOptions registration;
  bool pose_graph = true;  ///< false: sessions stay where registration has put them
  SessionGraphOptions graph;
  FusionOptions fusion;
};

/// Each of them by its name in PIPELINE, with its rule. The options must outlive the list.
OptionFields option_fields(ReconstructionOptions& options);

/// As the option `registration` has them.
const EnumNames<SessionRegistrationMethod>& registration_method_names();

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
