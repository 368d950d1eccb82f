#pragma once

#include "cmap/recon/reconstruction.hpp"
#include "cmap/render/image.hpp"

namespace cmap {

/// A picture of the sessions from above after each stage, a color for each session: pre-fusion, registration, pose
/// graph (as far as the run went). Cameras are dark dots, links between sessions red lines. Throws UnsupportedError
/// where the reconstruction has no sketches (it was not fused). The same bytes for any number of threads.
Image draw_reconstruction(const Reconstruction& reconstruction);

}  // namespace cmap
