#include "cmap/render/gl_module.hpp"

#include "cmap/core/loaded_module.hpp"

namespace cmap {

GlModule::GlModule()
    : table_(load_module<GlTable>("libcmap_gl.so",
                                  "this build has no OpenGL (tools/install_dependencies.sh --all, build again)")) {}

Splatter GlModule::open_splatter(std::string& device) const {
  GlTable::SplatInto splat_into;
  table_.open_splatter(splat_into, device);
  return [splat_into](const PointBlocks& points, const Projection& projection, const SplatOptions& options) {
    PixelMap pixels{projection.width_px, projection.height_px, {}};
    pixels.cells.resize(static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height));
    splat_into(points, projection, options, pixels);
    return pixels;
  };
}

}  // namespace cmap
