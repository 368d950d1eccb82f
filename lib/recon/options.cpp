#include "cmap/recon/options.hpp"

#include <fmt/format.h>

#include "cmap/core/error.hpp"
#include "cmap/core/option_fields.hpp"
#include "cmap/io/json_text.hpp"

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
const EnumNames<RegistrationMethod> kRegistrationNames{{RegistrationMethod::kPrefusion, "prefusion"},
                                                       {RegistrationMethod::kNormal, "normal"},
                                                       {RegistrationMethod::kPaper, "paper"},
                                                       {RegistrationMethod::kRobust, "robust"}};

constexpr NumberRange kCosine{.low = -1.0, .high = 1.0}, kFactor{.low = 1.0, .above_low = true};
constexpr NumberRange kCount{.low = 0, .high = 1e9}, kAtLeastOne{.low = 1, .high = 1e9};

template <class Fields>
void describe_input(Fields& f, FieldsOf<Fields, SessionInputOptions>& input) {
  f.field("points", input.points, kPointNames);
  f.field("confidence_lowest_share", input.confidence.lowest_share, kFraction);
  f.field("confidence_floor", input.confidence.floor, kNotNegative);
  f.field("farthest_median_depths", input.farthest_median_depths, kPositive);
  f.field("same_frame_s", input.same_frame_s, kNotNegative);
  f.field("pairing", input.pairing, kPairingNames);
  f.field("max_gap_s", input.max_gap_s, kPositive);
  auto& convention = input.convention;
  f.field("convention_min_length_m", convention.min_length_m, kNotNegative);
  f.field("convention_min_turn_deg", convention.min_turn_deg, kNotNegative);
  f.field("convention_contrary_cosine", convention.contrary_cosine, kCosine);
  f.field("convention_contrary_turn", convention.contrary_turn, kNotNegative);
  f.field("convention_same_cosine", convention.same_cosine, kCosine);
  f.field("convention_same_turn", convention.same_turn, kNotNegative);
  f.field("convention_same_turn_deg", convention.same_turn_deg, kNotNegative);
}

template <class Fields>
void describe_placement(Fields& f, FieldsOf<Fields, SessionPlacementOptions>& placement) {
  f.field("rotation", placement.rotation, kRotationNames);
  f.field("linearity_threshold", placement.linearity_threshold, kFraction);
  f.field("min_spread_m", placement.min_spread_m, kPositive);
  f.field("sigma_t_m", placement.sigma_position_m, kPositive);
  f.field("sigma_R_deg", placement.sigma_rotation_deg, kPositive);
  f.field("sigma_extrinsic_deg", placement.sigma_extrinsic_deg, kNotNegative);
  f.field("rotation_cauchy_deg", placement.cauchy_deg, kPositive);
  f.field("rotation_passes", placement.cauchy_passes, kCount);
  f.field("least_sigma_log_scale", placement.least_sigma_log_scale, kPositive);
}

template <class Fields>
void describe_prefusion(Fields& f, FieldsOf<Fields, PreFusionOptions>& prefusion) {
  describe_placement(f, prefusion.placement);
  f.field("overlap_scale", prefusion.overlap_scale, kOverlapNames);
  f.field("overlap_min_pixels", prefusion.overlap_min_pixels, kCount);
  auto& voting = prefusion.voting;
  f.field("voting", voting.mode, kVotingNames);
  f.field("voting_draws", voting.draws, NumberRange{1, 1e6});
  f.field("voting_seed", voting.seed, kCount);
  f.field("voting_deviations", voting.deviations, kPositive);
  f.field("voting_robust_deviations", voting.robust_deviations, kPositive);
  f.field("voting_least_tolerance", voting.least_tolerance, kFactor);
  f.field("voting_unlinked_tolerance", voting.unlinked_tolerance, kFactor);
  f.field("voting_min_voters", voting.min_voters, kCount);
  f.field("voting_cauchy_width", voting.cauchy_width, kPositive);
  f.field("voting_least_sigma_log", voting.least_sigma_log, kPositive);
  f.field("voting_max_alpha", voting.max_alpha, kNotNegative);
  f.field("voting_equal_share", voting.equal_share, kNotNegative);
}

template <class Fields>
void describe_registration(Fields& f, FieldsOf<Fields, RegistrationOptions>& registration) {
  f.field("registration", registration.method, kRegistrationNames);
  f.field("registration_voxel_m", registration.voxel_m, kPositive);
  f.field("registration_thinning", registration.thinning, kPositive);
  f.field("registration_first_gate", registration.first_gate, kPositive);
  f.field("registration_first_gate_sigmas", registration.first_gate_sigmas, kNotNegative);
  f.field("registration_last_gate", registration.last_gate, kPositive);
  f.field("registration_crop_cell", registration.crop_cell, kPositive);
  f.field("registration_first_beta", registration.first_beta, kPositive);
  f.field("registration_last_beta", registration.last_beta, kPositive);
  f.field("registration_iterations", registration.iterations, kAtLeastOne);
  f.field("registration_annealed_iterations", registration.annealed_iterations, kCount);
  f.field("registration_kernel_width", registration.kernel_width, kPositive);
  f.field("registration_neighbors", registration.neighbors, NumberRange{5, 64});
  f.field("registration_min_matches", registration.min_matches, kCount);
  f.field("registration_min_overlap", registration.min_overlap, kFraction);
  f.field("registration_match_gate", registration.match_gate, kPositive);
  f.field("lidar_voxel_m", registration.lidar.voxel_m, kPositive);
  f.field("lidar_min_range_m", registration.lidar.min_range_m, kNotNegative);
  f.field("lidar_margin_s", registration.lidar.margin_s, kNotNegative);
}

template <class Fields>
void describe_link(Fields& f, FieldsOf<Fields, LinkOptions>& link) {
  f.field("link_min_pixels", link.min_pixels, NumberRange{3, 1e9});
  f.field("link_max_pixels", link.max_pixels, kAtLeastOne);
  f.field("link_rounds", link.rounds, kAtLeastOne);
  f.field("link_thinning", link.thinning, kPositive);
  f.field("link_gate", link.gate, kPositive);
  f.field("link_iterations", link.iterations, kAtLeastOne);
  f.field("link_kernel_width", link.kernel_width, kPositive);
  f.field("link_neighbors", link.neighbors, NumberRange{5, 64});
}

template <class Fields>
void describe_graph(Fields& f, FieldsOf<Fields, ReconstructionOptions>& o) {
  f.field("pose_graph", o.pose_graph);
  auto& graph = o.graph;
  f.field("motion_reach", graph.motion_reach, kAtLeastOne);
  f.field("motion_sigma_share", graph.motion_sigma_share, kNotNegative);
  f.field("motion_sigma_m", graph.motion_sigma_m, kPositive);
  f.field("motion_sigma_deg", graph.motion_sigma_deg, kPositive);
  f.field("link_sigma_m", graph.link_sigma_m, kPositive);
  f.field("link_sigma_deg", graph.link_sigma_deg, kPositive);
  f.field("lidar_priors", graph.lidar_priors);
  f.field("prior_sigma_m", graph.prior_sigma_m, kPositive);
  f.field("prior_sigma_deg", graph.prior_sigma_deg, kPositive);
  f.field("odometry_sigma_m", graph.odometry_sigma_m, kPositive);
  f.field("odometry_sigma_deg", graph.odometry_sigma_deg, kPositive);
  f.field("odometry_gate_m", graph.odometry_gate_m, kNotNegative);
  f.field("odometry_gate_deg", graph.odometry_gate_deg, kNotNegative);
  f.field("graph_cauchy_width", graph.cauchy_width, kPositive);
}

template <class Fields>
void describe_fusion(Fields& f, FieldsOf<Fields, FusionOptions>& fusion) {
  f.field("fusion_voxel_m", fusion.voxel_m, kPositive);
  f.field("fusion_max_range_m", fusion.max_range_m, kNotNegative);
  f.field("fusion_color_width", fusion.color_width, kPositive);
  f.field("fusion_doubt", fusion.doubt, kFraction);
  f.field("fusion_doubt_cell_voxels", fusion.doubt_cell_voxels, kAtLeastOne);
}

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, ReconstructionOptions>& o) {
  describe_input(f, o.input);
  describe_prefusion(f, o.prefusion);
  describe_registration(f, o.registration);
  describe_link(f, o.registration.link);
  describe_graph(f, o);
  describe_fusion(f, o.fusion);
}

void apply(ReconstructionOptions& options, const Json& config) {
  FieldReader reader(config, "options");
  describe(reader, options);
  reader.finish();
}

}  // namespace

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
  options.registration.method = RegistrationMethod::kPaper;
  options.graph.lidar_priors = false;
}

Json to_json(const ReconstructionOptions& options) {
  FieldWriter writer;
  describe(writer, options);
  return writer.finish();
}

}  // namespace cmap
