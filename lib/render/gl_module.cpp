#include "cmap/render/gl_module.hpp"

#include "cmap/core/loaded_module.hpp"

namespace cmap {

GlModule::GlModule() {
  const LoadedModule module("libcmap_gl.so",
                            "this build has no OpenGL (tools/install_dependencies.sh --all, build again)");
  module.find("cmap_gl_open_splatter", open_splatter_);
  module.find("cmap_gl_require_display", require_display_);
  module.find("cmap_gl_view", view_);
}

Splatter GlModule::open_splatter(std::string& device) const {
  SplatInto splat_into;
  open_splatter_(splat_into, device);
  return [splat_into](const PointBlocks& points, const Projection& projection, const SplatOptions& options) {
    PixelMap pixels{projection.width_px, projection.height_px, {}};
    pixels.cells.resize(static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height));
    splat_into(points, projection, options, pixels);
    return pixels;
  };
}

}  // namespace cmap
