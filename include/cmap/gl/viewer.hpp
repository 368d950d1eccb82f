#pragma once

#include "cmap/render/gl_module.hpp"

namespace cmap {

/// Throws UsageError unless the X display of the environment can be opened and has OpenGL: VTK would abort the process.
void require_display();

/// Shows the scene in a window on the X display of the environment until the user closes it; h shows the keys. Points
/// are drawn by the scene's splatter, at most a million of each map while the camera moves. Throws UsageError as
/// require_display() does. Call from the main thread.
void view(const ViewerScene& scene);

}  // namespace cmap
