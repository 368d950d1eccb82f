#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/geometry/point_cloud.hpp"

namespace cmap {

/// A fast point feature histogram: three angles of 11 bins each.
using Fpfh = std::array<float, 33>;

/// FPFH of points with normals within a radius, by PCL; from a library that is loaded on first use, so that programs
/// start without PCL. Throws UnsupportedError where cmap was built without it. Points without neighbors give NaN.
Array<Fpfh> fpfh_features(std::span<const Eigen::Vector3f> points, std::span<const Eigen::Vector3f> normals,
                          double radius_m);

/// The features of the same points with all normals turned round: two of the three angles change their sign.
Fpfh with_flipped_normals(const Fpfh& feature);

/// Two points whose features are nearest to each other, both ways.
struct FeatureMatch {
  std::uint32_t source, target;
  float sq_dist;
};

/// All mutual matches, the most similar first.
std::vector<FeatureMatch> mutual_matches(const Array<Fpfh>& source, const Array<Fpfh>& target);

}  // namespace cmap
