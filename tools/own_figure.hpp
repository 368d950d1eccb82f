#pragma once

// The figure that a program draws itself; in builds without figures asking for one is an error.

#include <string>

#include "cmap/core/error.hpp"
#include "cmap/io/output_file.hpp"
#ifdef CMAP_WITH_RENDER
#include "cmap/render/image.hpp"
#endif

namespace cmap {

/// Before the work: whether it can be drawn and written. Empty: none was asked for.
inline void check_figure(const std::string& figure) {
  if (figure.empty()) return;
#ifdef CMAP_WITH_RENDER
  check_image_name(figure);
  require_writable(figure);
#else
  throw UnsupportedError("--figure: this build has no figures (tools/install_dependencies.sh --all, build again)");
#endif
}

}  // namespace cmap
