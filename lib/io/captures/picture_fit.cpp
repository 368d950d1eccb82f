#include "captures/picture_fit.hpp"

#include <fmt/format.h>

namespace cmap {
namespace {

bool is_in_the_middle(double share) { return share > 0.25 && share < 0.75; }

}  // namespace

std::string principal_point_doubt(double cx, double cy, int width, int height) {
  if (is_in_the_middle(cx / width) && is_in_the_middle(cy / height)) return {};
  std::string doubt =
      fmt::format("cx, cy = {:g}, {:g} are not near the middle of a picture of {} x {} pixels", cx, cy, width, height);
  if (is_in_the_middle(cx) && is_in_the_middle(cy)) {
    return doubt +
           fmt::format("; are they shares of its size? Multiply fx and cx by {}, fy and cy by {}", width, height);
  }
  if (!(cx > 0.0 && cy > 0.0)) return doubt;
  const double own_width = 2.0 * cx, own_height = 2.0 * cy;
  return doubt +
         fmt::format("; are they of one of about {:.0f} x {:.0f}? Multiply fx and cx by {:.4g}, fy and cy by {:.4g}",
                     own_width, own_height, width / own_width, height / own_height);
}

}  // namespace cmap
