// What cmap_render loads for OpenGL; see cmap/render/gl_module.hpp.

#include "cmap/gl/splat_gl.hpp"
#include "cmap/gl/viewer.hpp"

extern "C" {

void cmap_gl_open_splatter(std::function<void(const cmap::PointBlocks&, const cmap::Projection&,
                                              const cmap::SplatOptions&, cmap::PixelMap&)>& splat_into,
                           std::string& device) {
  const auto splatter = std::make_shared<cmap::GlSplatter>();
  device = splatter->device();
  splat_into = [splatter](const cmap::PointBlocks& points, const cmap::Projection& projection,
                          const cmap::SplatOptions& options,
                          cmap::PixelMap& pixels) { splatter->splat(points, projection, options, pixels); };
}

void cmap_gl_require_display() { cmap::require_display(); }

void cmap_gl_view(const cmap::ViewerScene& scene) { cmap::view(scene); }
}
