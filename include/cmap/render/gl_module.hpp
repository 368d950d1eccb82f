#pragma once

#include <string>

#include "cmap/render/figure.hpp"

namespace cmap {

/// What the viewer shows at first, and how it explains a point that was picked: one line each.
struct ViewerScene {
  std::string title;
  std::span<const Layer> layers;
  Camera camera;
  FigureOptions options;
  std::function<std::vector<std::string>(const PointBlocks& points, std::size_t slot)> describe_point;
};

/// What module gl gives those that load it.
struct GlTable {
  static constexpr const char* kModule = "gl";
  static constexpr int kTable = 1;
  /// Draws into cells that the program has allocated, as the module's memory is its own.
  using SplatInto = std::function<void(const PointBlocks&, const Projection&, const SplatOptions&, PixelMap&)>;
  void (*open_splatter)(SplatInto& splat_into, std::string& device);
  void (*require_display)();
  void (*view)(const ViewerScene& scene);
};

/// The module gl, loaded when it is asked for: programs that may draw by OpenGL start without it.
class GlModule {
 public:
  /// Throws UnsupportedError where cmap was built without OpenGL.
  GlModule();

  /// A splatter for FigureOptions that draws by OpenGL (cmap/gl/splat_gl.hpp), and the device's name. Throws UsageError
  /// where there is no device. Use from one thread at a time.
  Splatter open_splatter(std::string& device) const;

  /// Throws UsageError where view() would.
  void require_display() const { table_.require_display(); }

  /// Shows the scene in a window until the user closes it; see cmap/gl/viewer.hpp.
  void view(const ViewerScene& scene) const { table_.view(scene); }

 private:
  const GlTable& table_;
};

}  // namespace cmap
