#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cmap/core/array.hpp"
#include "cmap/sim/predictions.hpp"

namespace cmap {

/// Predicted depth (m) and confidence of one frame.
struct PredictedDepth {
  Array<float> depth_m;
  Array<float> confidence;
};

/// Which errors are drawn: of the depth head or of the point head of one session's frame.
struct ErrorDraw {
  std::uint64_t seed;
  std::uint64_t field_purpose, pixel_purpose;
  std::size_t session, frame;
};

/// The frame's true depth (infinite: sky) with the errors of simulate_session().
PredictedDepth with_depth_errors(const Array<float>& true_depth_m, int width, int height,
                                 const PredictionOptions& options, const ErrorDraw& draw);

}  // namespace cmap
