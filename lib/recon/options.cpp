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
const EnumNames<Registration> kRegistrationNames{{Registration::kPrefusion, "prefusion"},
                                                 {Registration::kNormal, "normal"},
                                                 {Registration::kPaper, "paper"},
                                                 {Registration::kRobust, "robust"}};

template <class Fields>
void describe(Fields& f, FieldsOf<Fields, ReconstructionOptions>& o) {
  f.field("points", o.points, kPointNames);
  f.field("confidence_lowest_share", o.confidence.lowest_share, kFraction);
  f.field("confidence_floor", o.confidence.floor, kNotNegative);
  f.field("pairing", o.prefusion.pairing, kPairingNames);
  f.field("max_gap_s", o.prefusion.max_gap_s, kPositive);
  f.field("rotation", o.prefusion.registration.rotation, kRotationNames);
  f.field("linearity_threshold", o.prefusion.registration.linearity_threshold, kFraction);
  f.field("sigma_t_m", o.prefusion.registration.sigma_position_m, kPositive);
  f.field("sigma_R_deg", o.prefusion.registration.sigma_rotation_deg, kPositive);
  f.field("sigma_extrinsic_deg", o.prefusion.registration.sigma_extrinsic_deg, kNotNegative);
  f.field("overlap_scale", o.overlap_scale, kOverlapNames);
  f.field("voting", o.prefusion.voting.mode, kVotingNames);
  f.field("voting_draws", o.prefusion.voting.draws, NumberRange{1, 1e6});
  f.field("registration", o.registration, kRegistrationNames);
  f.field("registration_voxel_m", o.registration_voxel_m, kPositive);
  f.field("lidar_voxel_m", o.lidar.voxel_m, kPositive);
  f.field("lidar_min_range_m", o.lidar.min_range_m, kNotNegative);
  f.field("lidar_margin_s", o.lidar.margin_s, kNotNegative);
  f.field("pose_graph", o.pose_graph);
  f.field("lidar_priors", o.lidar_priors);
  f.field("fusion_voxel_m", o.fusion_voxel_m, kPositive);
  f.field("fusion_max_range_m", o.fusion_max_range_m, kNotNegative);
  f.field("fusion_doubt", o.fusion_doubt, kFraction);
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
  options.prefusion = PreFusionOptions::paper();
  options.overlap_scale = OverlapScale::kCenters;
  options.registration = Registration::kPaper;
  options.lidar_priors = false;
}

Json to_json(const ReconstructionOptions& options) {
  FieldWriter writer;
  describe(writer, options);
  return writer.finish();
}

}  // namespace cmap
