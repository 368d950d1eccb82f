#include "cmap/eval/options.hpp"

#include <algorithm>

#include "cmap/eval/bootstrap.hpp"
#include "option_values.hpp"

namespace cmap {
namespace {

constexpr CountRange kAtLeastTwo{2, 1'000'000'000};

const EnumNames<Observed> kObservedNames{
    {Observed::kNone, "none"}, {Observed::kAuto, "auto"}, {Observed::kSensor, "sensor"}};
const EnumNames<IndexKind> kIndexNames{{IndexKind::kBvh, "bvh"}, {IndexKind::kFlann, "flann"}};

OptionFields metric_fields(EvaluationOptions& o) {
  return {
      beside({"metrics", metric_names_value(o.metrics), "LIST",
              "groups (color, color+, geometry, distribution, mme, density, all), metric ids or symbols"}),
      {"thresholds", thresholds_value(o.thresholds_m), "METERS,...", "of accuracy, fitness, completeness, F-score"},
      field("overlap-distance", o.overlap_distance_m, kPositive, "METERS",
            "of overlap, truncated Chamfer and inlier RMSE"),
      field("lcr-tau", o.lcr_tau, kPositive, "TAU", "a color is right within 3 tau, unit RGB"),
      field("lcr-radius", o.lcr_radius_m, kPositive, "METERS", "within which LCR looks for the right color"),
      beside(field("lcr-curve", o.lcr_curve, "LCR for tau = 0.02 ... 0.30 and the area under the curve")),
      field("ccs-voxel", o.ccs_voxel_m, kPositive, "METERS", "voxel of color consistency"),
      field("ccs-singletons", o.ccs_singletons, singletons_names(), nullptr,
            "a voxel of one point counts as 0, is left out, or ends the program"),
      field("ccs-min-points", o.ccs_min_points, kAtLeastTwo, "N",
            "points that such a voxel needs where others are left out"),
      beside(field("ccs-phases", o.ccs_phases, "color consistency on shifted grids of voxels, too")),
      field("cw-voxel", o.cw_voxel_m, kPositive, "METERS", "voxel of color Wasserstein"),
      field("cw-min-points", o.cw_min_points, kAtLeastTwo, "N", "points of each map that such a voxel needs"),
      field("awd-voxel", o.awd_voxel_m, kPositive, "METERS", "voxel of the average Wasserstein distance"),
      field("awd-min-points", o.awd_min_points, kAtLeastTwo, "N", "points of each map that such a voxel needs"),
      field("scs-radius", o.scs_radius_voxels, {1, 1000}, "VOXELS", "neighborhood of spatial consistency"),
      field("mme-radius", o.mme_radius_m, kPositive, "METERS", "neighborhood of mean map entropy"),
      field("mme-min-neighbors", o.mme_min_neighbors, kAtLeastTwo, "N", "neighbors that a point needs"),
      field("color-max-distance", o.color_max_distance_m, kPositive, "METERS",
            "leave farther pairs out of color distance"),
      beside(field("grid-phases", o.grid_phases, grid_phases_names(), nullptr,
                   "grids, shifted by parts of a voxel, on which AWD, SCS and CW are evaluated")),
      beside(field("no-levels", o.no_levels, "leave out what each value is worth: floor, chance, skill")),
  };
}

OptionFields map_fields(EvaluationOptions& o) {
  return {
      field("voxel", o.voxel_m, kPositive, "METERS", "thin both maps first: mean position and color per voxel"),
      {"crop", crop_value(o.crop), "X0,Y0,Z0,X1,Y1,Z1", "keep this box of both maps, in the reference frame"},
  };
}

/// What is said beside the metrics.
OptionFields further_fields(EvaluationOptions& o) {
  OptionFields fields{
      {"as", tools_value(o.as), "TOOLS",
       "also what color-map-evaluation (the paper's authors'), cloudanalyzer, mapeval, open3d, mpeg, cloudcompare or "
       "tanksandtemples would print"},
      field("bootstrap", o.bootstrap, {0, kMostReplicates}, "N",
            "confidence intervals of 95 % from N replicates of blocks of the map"),
      field("block", o.block_m, kPositive, "METERS", "edge of those blocks"),
      field("bootstrap-seed", o.bootstrap_seed, {0, 1'000'000'000}, "N", "of the random numbers that draw them"),
      field("observed", o.observed, kObservedNames, nullptr,
            "also the metrics without what the other map could not have seen: auto, nothing within 1 m columns; "
            "sensor, the reference as --observed-from sees it"),
      field("observed-range", o.visibility.range_m, kPositive, "METERS", "how far that sensor sees"),
      field("observed-voxel", o.visibility.voxel_m, kPositive, "METERS",
            "voxels of the reference that hide others from it"),
  };
  std::ranges::transform(fields, fields.begin(), beside);
  return fields;
}

OptionFields alignment_fields(EvaluationOptions& o) {
  return {
      field("align", o.align, align_method_names(), "METHOD",
            "move the estimate first: none, a method of cmap_align, trajectory or tanksandtemples"),
      field("align-voxel", o.align_voxel_m, kPositive, "METERS",
            "thinning for the alignment; by default from the reference's size"),
      field("align-distance", o.align_distance_m, kPositive, "METERS",
            "farther pairs are no matches; by default 10 voxels"),
      field("align-scale", o.align_scale, "also find the scale, where the method leaves the choice (sim3 always does)"),
      beside(field("allow-unconverged", o.allow_unconverged,
                   "score also what an alignment that is not to be trusted gives; else it ends with exit code 4")),
      field("trajectory-fit", o.trajectory_fit, trajectory_fit_names(), "FIT",
            "of trajectories: first-frame, se3 or sim3"),
      field("trajectory-pairing", o.trajectory_pairing, time_pairing_names(), "PAIRING",
            "the reference's poses interpolated, or the nearest within 10 ms"),
      field("trajectory-max-gap", o.trajectory_max_gap_s, kPositive, "SECONDS",
            "poses farther apart are not interpolated between"),
      field("trajectory-time-offset", o.trajectory_time_offset_s, kAnyNumber, "SECONDS",
            "added to the times of the estimate's trajectory; cmap_align --time-offset estimate finds it"),
      field("tanksandtemples-tau", o.tanks_and_temples_tau_m, kPositive, "METERS",
            "its threshold; by default the largest of the thresholds"),
  };
}

OptionFields sensitivity_fields(EvaluationOptions& o) {
  return {
      beside(field("sensitivity", o.sensitivity, "how far every metric goes when the alignment is a little off")),
      beside(field("sensitivity-translation", o.sensitivity_translation_m, kPositive, "METERS",
                   "that little, along every axis")),
      beside(field("sensitivity-rotation", o.sensitivity_rotation_deg, kPositive, "DEGREES", "and about every axis")),
  };
}

OptionFields reading_fields(EvaluationOptions& o) {
  return {
      field("index", o.index, kIndexNames, nullptr, "nearest-neighbor index"),
      field("keep-noise", o.keep_noise, "LAS: points of the noise classes 7 and 18 count too"),
      {"classes", BytesValue{&o.classes, "classes"}, "N,...", "LAS: only points of these classes count (2 is ground)"},
  };
}

}  // namespace

OptionFields option_fields(EvaluationOptions& options) {
  return joined({metric_fields(options), map_fields(options), further_fields(options), alignment_fields(options),
                 sensitivity_fields(options), reading_fields(options)});
}

ReadOptions read_options(const EvaluationOptions& options, bool sha256) {
  return {.sha256 = sha256, .keep_noise = options.keep_noise, .classes = options.classes};
}

double tanks_and_temples_tau_m(const EvaluationOptions& options) {
  return options.tanks_and_temples_tau_m.value_or(std::ranges::max(options.thresholds_m));
}

}  // namespace cmap
