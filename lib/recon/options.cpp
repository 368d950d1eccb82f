#include "cmap/recon/options.hpp"

#include <fmt/format.h>

#include "cmap/core/error.hpp"
#include "cmap/io/json_text.hpp"
#include "cmap/io/options_json.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

const EnumNames<PointSource> kPointNames{{PointSource::kDepth, "depth"}, {PointSource::kHead, "head"}};
const EnumNames<PosePairing> kPairingNames{{PosePairing::kInterpolated, "interpolated"},
                                           {PosePairing::kNearest, "nearest"}};
const EnumNames<RotationCorrection> kRotationNames{{RotationCorrection::kJoint, "joint"},
                                                   {RotationCorrection::kPaper, "paper"}};
const EnumNames<OverlapScale> kOverlapNames{{OverlapScale::kDepths, "depths"}, {OverlapScale::kCenters, "centers"}};
const EnumNames<ScaleVoting> kVotingNames{{ScaleVoting::kRobust, "robust"}, {ScaleVoting::kPaper, "paper"}};

constexpr NumberRange kCosine{.low = -1.0, .high = 1.0}, kFactor{.low = 1.0, .above_low = true};
constexpr NumberRange kCount{.low = 0, .high = 1e9}, kAtLeastOne{.low = 1, .high = 1e9};

OptionFields input_fields(SessionInputOptions& input) {
  auto& convention = input.convention;
  return {
      field("points", input.points, kPointNames),
      field("confidence_lowest_share", input.confidence.lowest_share, kFraction),
      field("confidence_floor", input.confidence.floor, kNotNegative),
      field("farthest_median_depths", input.farthest_median_depths, kPositive),
      field("same_frame_s", input.same_frame_s, kNotNegative),
      field("pairing", input.pairing, kPairingNames),
      field("max_gap_s", input.max_gap_s, kPositive),
      field("convention_min_length_m", convention.min_length_m, kNotNegative),
      field("convention_min_turn_deg", convention.min_turn_deg, kNotNegative),
      field("convention_contrary_cosine", convention.contrary_cosine, kCosine),
      field("convention_contrary_turn", convention.contrary_turn, kNotNegative),
      field("convention_same_cosine", convention.same_cosine, kCosine),
      field("convention_same_turn", convention.same_turn, kNotNegative),
      field("convention_same_turn_deg", convention.same_turn_deg, kNotNegative),
  };
}

OptionFields placement_fields(SessionPlacementOptions& placement) {
  return {
      field("rotation", placement.rotation, kRotationNames),
      field("linearity_threshold", placement.linearity_threshold, kFraction),
      field("min_spread_m", placement.min_spread_m, kPositive),
      field("sigma_t_m", placement.sigma_position_m, kPositive),
      field("sigma_R_deg", placement.sigma_rotation_deg, kPositive),
      field("sigma_extrinsic_deg", placement.sigma_extrinsic_deg, kNotNegative),
      field("rotation_cauchy_deg", placement.cauchy_deg, kPositive),
      field("rotation_passes", placement.cauchy_passes, kCount),
      field("least_sigma_log_scale", placement.least_sigma_log_scale, kPositive),
  };
}

OptionFields prefusion_fields(PreFusionOptions& prefusion) {
  auto& voting = prefusion.voting;
  return {
      field("overlap_scale", prefusion.overlap_scale, kOverlapNames),
      field("overlap_min_pixels", prefusion.overlap_min_pixels, kCount),
      field("voting", voting.mode, kVotingNames),
      field("voting_draws", voting.draws, NumberRange{1, 1e6}),
      field("voting_seed", voting.seed, kCount),
      field("voting_deviations", voting.deviations, kPositive),
      field("voting_robust_deviations", voting.robust_deviations, kPositive),
      field("voting_least_tolerance", voting.least_tolerance, kFactor),
      field("voting_unlinked_tolerance", voting.unlinked_tolerance, kFactor),
      field("voting_min_voters", voting.min_voters, kCount),
      field("voting_cauchy_width", voting.cauchy_width, kPositive),
      field("voting_least_sigma_log", voting.least_sigma_log, kPositive),
      field("voting_max_alpha", voting.max_alpha, kNotNegative),
      field("voting_equal_share", voting.equal_share, kNotNegative),
  };
}

OptionFields registration_fields(RegistrationOptions& registration) {
  return {
      field("registration", registration.method, registration_method_names()),
      field("registration_voxel_m", registration.voxel_m, kPositive),
      field("registration_thinning", registration.thinning, kPositive),
      field("registration_first_gate", registration.first_gate, kPositive),
      field("registration_first_gate_sigmas", registration.first_gate_sigmas, kNotNegative),
      field("registration_last_gate", registration.last_gate, kPositive),
      field("registration_crop_cell", registration.crop_cell, kPositive),
      field("registration_first_beta", registration.first_beta, kPositive),
      field("registration_last_beta", registration.last_beta, kPositive),
      field("registration_iterations", registration.iterations, kAtLeastOne),
      field("registration_annealed_iterations", registration.annealed_iterations, kCount),
      field("registration_kernel_width", registration.kernel_width, kPositive),
      field("registration_neighbors", registration.neighbors, NumberRange{5, 64}),
      field("registration_min_matches", registration.min_matches, kCount),
      field("registration_min_overlap", registration.min_overlap, kFraction),
      field("registration_match_gate", registration.match_gate, kPositive),
      field("lidar_voxel_m", registration.lidar.voxel_m, kPositive),
      field("lidar_min_range_m", registration.lidar.min_range_m, kNotNegative),
      field("lidar_margin_s", registration.lidar.margin_s, kNotNegative),
      field("lidar_in_view", registration.lidar_in_view),
  };
}

OptionFields link_fields(LinkOptions& link) {
  return {
      field("link_min_pixels", link.min_pixels, NumberRange{3, 1e9}),
      field("link_max_pixels", link.max_pixels, kAtLeastOne),
      field("link_rounds", link.rounds, kAtLeastOne),
      field("link_thinning", link.thinning, kPositive),
      field("link_gate", link.gate, kPositive),
      field("link_iterations", link.iterations, kAtLeastOne),
      field("link_kernel_width", link.kernel_width, kPositive),
      field("link_neighbors", link.neighbors, NumberRange{5, 64}),
  };
}

OptionFields graph_fields(ReconstructionOptions& o) {
  auto& graph = o.graph;
  return {
      field("pose_graph", o.pose_graph),
      field("motion_reach", graph.motion_reach, kAtLeastOne),
      field("motion_sigma_share", graph.motion_sigma_share, kNotNegative),
      field("motion_sigma_m", graph.motion_sigma_m, kPositive),
      field("motion_sigma_deg", graph.motion_sigma_deg, kPositive),
      field("link_sigma_m", graph.link_sigma_m, kPositive),
      field("link_sigma_deg", graph.link_sigma_deg, kPositive),
      field("lidar_priors", graph.lidar_priors),
      field("prior_sigma_m", graph.prior_sigma_m, kPositive),
      field("prior_sigma_deg", graph.prior_sigma_deg, kPositive),
      field("odometry_sigma_m", graph.odometry_sigma_m, kPositive),
      field("odometry_sigma_deg", graph.odometry_sigma_deg, kPositive),
      field("odometry_gate_m", graph.odometry_gate_m, kNotNegative),
      field("odometry_gate_deg", graph.odometry_gate_deg, kNotNegative),
      field("graph_cauchy_width", graph.cauchy_width, kPositive),
  };
}

OptionFields fusion_fields(FusionOptions& fusion) {
  return {
      field("fusion_voxel_m", fusion.voxel_m, kPositive),
      field("fusion_max_range_m", fusion.max_range_m, kNotNegative),
      field("fusion_color_width", fusion.color_width, kPositive),
      field("fusion_doubt", fusion.doubt, kFraction),
      field("fusion_doubt_cell_voxels", fusion.doubt_cell_voxels, kAtLeastOne),
  };
}

void apply(ReconstructionOptions& options, const Json& config) {
  set_from_json(option_fields(options), config, "options");
}

}  // namespace

const EnumNames<SessionRegistrationMethod>& registration_method_names() {
  static const EnumNames<SessionRegistrationMethod> names{{SessionRegistrationMethod::kPrefusion, "prefusion"},
                                                          {SessionRegistrationMethod::kNormal, "normal"},
                                                          {SessionRegistrationMethod::kPaper, "paper"},
                                                          {SessionRegistrationMethod::kRobust, "robust"}};
  return names;
}

OptionFields option_fields(ReconstructionOptions& o) {
  return joined({input_fields(o.input), placement_fields(o.prefusion.placement), prefusion_fields(o.prefusion),
                 registration_fields(o.registration), link_fields(o.registration.link), graph_fields(o),
                 fusion_fields(o.fusion)});
}

void apply_reconstruction_config(ReconstructionOptions& options, const std::string& json_text,
                                 const std::string& source) {
  read_json(json_text, source, [&](const Json& config) { apply(options, config); });
}

void apply_reconstruction_config_file(ReconstructionOptions& options, const std::filesystem::path& path) {
  read_json_file(path, "a configuration file", [&](const Json& config) { apply(options, config); });
}

void set_reconstruction_option(ReconstructionOptions& options, const std::string& assignment) {
  const auto [name, value] = read_assignment(assignment, "name=value");
  apply(options, {{name, value}});
}

void apply_reconstruction_preset(ReconstructionOptions& options, const std::string& name) {
  if (name == "default") return;
  if (name != "paper") throw UsageError(fmt::format("\"{}\" is no preset: default, paper", name));
  options.input.pairing = PosePairing::kNearest;
  options.prefusion = PreFusionOptions::paper();
  options.registration.method = SessionRegistrationMethod::kPaper;
  options.graph.lidar_priors = false;
}

Json to_json(const ReconstructionOptions& options) { return options_json_of(options); }

}  // namespace cmap
