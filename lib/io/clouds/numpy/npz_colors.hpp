#pragma once

#include "clouds/numpy/npy_points.hpp"

namespace cmap {

/// How an array holds a value, or a color of three or four channels, for each of some points.
struct PointMatch {
  std::size_t channels = 1;
  bool planes = false;       ///< the channels in planes of their own, for each frame
  std::uint64_t frames = 1;  ///< of planes
};

/// Whether an array of this shape holds `channels` numbers for each point of an array of `point_shape`: (..., channels)
/// or (..., channels, H, W), or (channels, N). Dimensions of 1 in front count for nothing. Two arrays of several
/// dimensions must agree in each, so that height and width are never exchanged.
std::optional<PointMatch> match_points(const std::vector<std::uint64_t>& shape, std::size_t channels,
                                       const std::vector<std::uint64_t>& point_shape);
/// As colors, of three or four channels.
std::optional<PointMatch> match_colors(const std::vector<std::uint64_t>& shape,
                                       const std::vector<std::uint64_t>& point_shape);

/// Gives the points their colors from another array of numbers, which must outlive them.
void set_colors(NpyPoints& points, const NpyArray& colors, const PointMatch& match);
/// The same from three arrays: red, green and blue.
void set_colors(NpyPoints& points, const std::vector<const NpyArray*>& channels);
/// The same for 0x..RRGGBB, in integers or in the bits of floats.
void set_packed_colors(NpyPoints& points, const NpyArray& packed);

}  // namespace cmap
