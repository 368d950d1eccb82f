#include "cmap/colorize/colorize.hpp"

namespace cmap {
namespace {

const EnumNames<ExposureModel> kExposureNames{
    {ExposureModel::kNone, "none"}, {ExposureModel::kGain, "gain"}, {ExposureModel::kChannels, "channels"}};

constexpr NumberRange kMicrometers{.low = 1e-6, .high = 1e6};

OptionFields occlusion_fields(OcclusionOptions& o) {
  return {
      field("tolerance_m", o.tolerance_m, kNotNegative),
      field("relative_tolerance", o.relative_tolerance, kFraction),
      field("thickness_m", o.thickness_m, kNotNegative),
      field("largest_tolerance_m", o.largest_tolerance_m, kNotNegative),
      field("edge_px", o.edge_px, NumberRange{0, 64}),
      field("max_range_m", o.max_range_m, kPositive),
      field("largest_splat_px", o.largest_splat_px, NumberRange{0, 1024}),
      field("most_pixels", o.most_pixels, NumberRange{1, 1e9}),
  };
}

OptionFields weight_fields(ViewWeightOptions& o) {
  return {
      field("angle_power", o.angle_power, kNotNegative),
      field("least_cosine", o.least_cosine, NumberRange{1e-3, 1.0}),
      field("range_power", o.range_power, NumberRange{0, 8}),
      field("near_range_m", o.near_range_m, kPositive),
      field("border_share", o.border_share, kFraction),
      field("least_border_weight", o.least_border_weight, NumberRange{1e-3, 1.0}),
  };
}

OptionFields exposure_fields(ExposureOptions& o) {
  return {
      field("exposure", o.model, kExposureNames),
      field("exposure_sigma_gain", o.sigma_gain, kPositive),
      field("exposure_least_sigma", o.least_sigma, kPositive),
      field("exposure_darkest", o.darkest, NumberRange{1, 255}),
      field("exposure_brightest", o.brightest, NumberRange{1, 255}),
      field("exposure_passes", o.passes, NumberRange{1, 1000}),
  };
}

}  // namespace

OptionFields fields_of(ColorizeOptions& options) {
  return joined({{field("surfel_m", options.surfel_m, kMicrometers, "METERS", ""),
                  field("neighbors", options.neighbors, NumberRange{3, 63}),
                  field("most_views", options.most_views, NumberRange{1, 255})},
                 occlusion_fields(options.occlusion),
                 weight_fields(options.weight),
                 exposure_fields(options.exposure)});
}

}  // namespace cmap
