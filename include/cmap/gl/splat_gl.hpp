#pragma once

#include <memory>
#include <string>

#include "cmap/render/splat.hpp"

namespace cmap {

class Worker;

/// splat() by OpenGL, off screen and without a display: on the first GPU that EGL finds, else in software (Mesa's
/// llvmpipe). Each object has a context and a thread of its own and may be
/// used from any thread, one at a time.
class GlSplatter {
 public:
  /// Throws UsageError where there is no OpenGL 4.5 or ARB_clip_control.
  GlSplatter();
  ~GlSplatter();
  GlSplatter(const GlSplatter&) = delete;
  GlSplatter& operator=(const GlSplatter&) = delete;

  /// The device as OpenGL calls it, and its version.
  std::string device() const;

  /// The same squares, depths and rules as splat(); a device that rounds differently may move a square by a pixel and
  /// change the last bits of a depth. `pixels` has the projection's size and is overwritten; pictures larger than the
  /// device allows are drawn in tiles. Throws UsageError for points larger than the device can draw.
  void splat(const PointBlocks& points, const Projection& projection, const SplatOptions& options, PixelMap& pixels);

 private:
  struct Device;
  std::unique_ptr<Worker> worker_;  ///< where all of OpenGL is called
  std::unique_ptr<Device> device_;
};

}  // namespace cmap
