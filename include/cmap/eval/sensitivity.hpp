#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "cmap/core/execution.hpp"
#include "cmap/eval/options.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

class MetricRecords;

/// How far one value goes.
struct SensitivityRange {
  std::string_view id;
  std::optional<double> threshold_m;
  double lowest, highest;
};

/// How far every metric goes when the alignment is a little off. A score that moves more than two methods differ by
/// says nothing about which one is better.
struct Sensitivity {
  double translation_m = 0.0, rotation_deg = 0.0;
  std::vector<SensitivityRange> ranges;  ///< in the order of reports, the largest threshold first
};

/// Collects the values of several evaluations.
class SensitivityBand {
 public:
  /// Widens the band to these values.
  void include(const MetricRecords& metrics);
  Sensitivity found(const EvaluationOptions& options) const;

 private:
  struct Range {
    double lowest, highest;
  };
  std::map<std::string_view, std::map<std::optional<double>, Range>> ranges_;  ///< by metric and threshold
};

/// Evaluates the pair after each of twelve small motions of the estimate, in the reference frame: forth and back along
/// the axes by options.sensitivity_translation_m, and about them through the estimate's centroid by
/// options.sensitivity_rotation_deg. Throws as evaluate does.
SensitivityBand sensitivity_band(const PointCloud& reference, const PointCloud& estimate,
                                 const EvaluationOptions& options, const Eigen::Matrix4d& T_ref_est,
                                 const Execution& execution = {});

}  // namespace cmap
