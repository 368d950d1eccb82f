#include "cmap/render/gl_module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

template <class Function>
void find_function(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  if (function == nullptr) throw UsageError(fmt::format("OpenGL: {}", ::dlerror()));
}

}  // namespace

GlModule::GlModule() {
  // Found by the program's run path; never unloaded, as VTK's libraries do not survive that.
  void* library = ::dlopen("libcmap_gl.so", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw UsageError(
        fmt::format("this build has no OpenGL (apt-get install libvtk9-dev libegl-dev libgl-dev libx11-dev, then build "
                    "again): {}",
                    ::dlerror()));
  }
  find_function(library, "cmap_gl_open_splatter", open_splatter_);
  find_function(library, "cmap_gl_require_display", require_display_);
  find_function(library, "cmap_gl_view", view_);
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
