// What cmap_render loads for OpenGL.

#include "cmap/render/gl_module.hpp"

#include "cmap/core/loaded_module.hpp"
#include "cmap/gl/splat_gl.hpp"
#include "cmap/gl/viewer.hpp"

namespace cmap {
namespace {

void open_splatter(GlTable::SplatInto& splat_into, std::string& device) {
  const auto splatter = std::make_shared<GlSplatter>();
  device = splatter->device();
  splat_into = [splatter](const PointBlocks& points, const Projection& projection, const SplatOptions& options,
                          PixelMap& pixels) { splatter->splat(points, projection, options, pixels); };
}

constexpr GlTable kTable{.open_splatter = open_splatter, .require_display = require_display, .view = view};

}  // namespace
}  // namespace cmap

cmap::ModuleAnswer cmap_module(const char* build, const cmap::ModuleHost* host) {
  return cmap::answer_of_module(cmap::kTable, build, host);
}
