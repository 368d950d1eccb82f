#include "viewer_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cmap/render/panels.hpp"
#include "viewer_marks.hpp"

namespace cmap {
namespace {

constexpr std::size_t kPointsWhileMoving = 1'000'000;
constexpr int kFineSamples = 2;
constexpr int kSmallestWidth_px = 320, kSmallestHeight_px = 240;

const std::vector<std::string> kHelp{"drag: turn",
                                     "middle or shift drag: move",
                                     "wheel or right drag: zoom",
                                     "click or p: values of a point",
                                     "f: turn about that point",
                                     "1 ... 9, left, right: layer",
                                     "+ -: size of points",
                                     "o: parallel projection",
                                     "r: back to the first view",
                                     "s: save the picture",
                                     "h: this help",
                                     "q: quit"};

}  // namespace

ViewerModel::ViewerModel(const ViewerScene& scene) : scene_(scene), orbit_(scene.camera), options_(scene.options) {
  resize(options_.width_px, options_.height_px);
  for (const Layer& shown : scene.layers) coarse_.try_emplace(shown.points, *shown.points, kPointsWhileMoving);
}

void ViewerModel::show_layer(std::size_t layer) {
  layer_ = layer;
  // Values are those of a point of the map that is shown.
  if (picked_ && picked_->points != this->layer().points) picked_.reset();
}

ViewerModel::Answer ViewerModel::press(std::string_view key) {
  constexpr double kLargerPoints = 1.25;
  const std::size_t n = scene_.layers.size();
  message_.clear();
  if (key == "q" || key == "Escape") return Answer::kQuit;
  if (key == "s") return Answer::kSave;
  if (key == "h") {
    help_ = !help_;
  } else if (key == "f" && picked_) {
    orbit_.look_at(picked_->points->world(picked_->slot));
    forget_view();
  } else if (key == "r") {
    orbit_ = OrbitCamera(scene_.camera);
    options_.point_size = scene_.options.point_size;
    forget_view();
  } else if (key == "o") {
    orbit_.toggle_projection();
    forget_view();
  } else if (key == "plus" || key == "equal" || key == "KP_Add" || key == "minus" || key == "KP_Subtract") {
    const bool larger = key != "minus" && key != "KP_Subtract";
    options_.point_size = std::clamp(options_.point_size * (larger ? kLargerPoints : 1.0 / kLargerPoints), 0.01, 100.0);
    forget_view();
  } else if (key == "Right" || key == "Left") {
    show_layer((layer_ + (key == "Right" ? 1 : n - 1)) % n);
  } else if (key.size() == 1 && key[0] >= '1' && key[0] <= '9' && static_cast<std::size_t>(key[0] - '1') < n) {
    show_layer(static_cast<std::size_t>(key[0] - '1'));
  } else {
    return Answer::kNothing;
  }
  return Answer::kRedraw;
}

void ViewerModel::drag(Drag what, int right_px, int down_px) {
  constexpr double kDegreesPerPixel = 0.3, kZoomPerPixel = 1.007;
  switch (what) {
    case Drag::kTurn:
      orbit_.turn(-kDegreesPerPixel * right_px, kDegreesPerPixel * down_px);
      break;
    case Drag::kPan:
      orbit_.pan(right_px, down_px, panel_place(0, 1, options_).height);
      break;
    case Drag::kZoom:
      orbit_.zoom(std::pow(kZoomPerPixel, -down_px));
      break;
  }
  forget_view();
}

void ViewerModel::zoom(double factor) {
  orbit_.zoom(factor);
  forget_view();
}

void ViewerModel::resize(int width_px, int height_px) {
  options_.width_px = std::clamp(width_px, kSmallestWidth_px, kMostPixels);
  options_.height_px = std::clamp(height_px, kSmallestHeight_px, kMostPixels);
  forget_view();
}

std::vector<std::string> ViewerModel::pick(int x, int y) {
  constexpr int kReach_px = 4;
  picked_.reset();
  if (!seen_.contains(layer().points)) figure(false);
  const PixelMap& pixels = seen_.at(layer().points);
  const Rect place = panel_place(0, 1, options_);
  int nearest_sq = kReach_px * kReach_px * kFineSamples * kFineSamples + 1;
  const int reach = kReach_px * kFineSamples;
  const int middle_x = (x - place.x) * kFineSamples, middle_y = (y - place.y) * kFineSamples;
  for (int row = std::max(0, middle_y - reach); row <= std::min(pixels.height - 1, middle_y + reach); ++row) {
    for (int column = std::max(0, middle_x - reach); column <= std::min(pixels.width - 1, middle_x + reach); ++column) {
      const std::size_t cell =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels.width) + static_cast<std::size_t>(column);
      const int sq = (row - middle_y) * (row - middle_y) + (column - middle_x) * (column - middle_x);
      if (sq >= nearest_sq || pixels.is_empty(cell)) continue;
      nearest_sq = sq;
      picked_ = Picked{layer().points, pixels.slot(cell), {}};
    }
  }
  if (!picked_) return {};
  picked_->lines = scene_.describe_point(*picked_->points, picked_->slot);
  return picked_->lines;
}

const PixelMap& ViewerModel::seen(const PointBlocks& points, const Projection& projection,
                                  const SplatOptions& options) {
  const auto [place, is_new] = seen_.try_emplace(&points);
  if (is_new) place->second = scene_.options.splatter(points, projection, options);
  return place->second;
}

Image ViewerModel::figure(bool moving) {
  FigureOptions options = options_;
  options.samples = moving ? 1 : kFineSamples;
  options.splatter = [&](const PointBlocks& points, const Projection& projection, const SplatOptions& splat_options) {
    if (moving) return coarse_.at(&points).splat(scene_.options.splatter, projection, splat_options);
    return seen(points, projection, splat_options);
  };
  return draw_figure({&layer(), 1}, orbit_.camera(), options);
}

void ViewerModel::draw_marks(Image& image) const {
  const Rect place = panel_place(0, 1, options_);
  const Pen pen = panel_pen(1, options_);
  if (picked_) {
    const Projection projection(orbit_.camera(), place.width, place.height);
    const Eigen::Vector3d d = projection.axes * (picked_->points->world(picked_->slot) - projection.position);
    const Eigen::Vector2d at = projection.focal_px / (projection.orthographic ? 1.0 : d.z()) * d.head<2>();
    const bool in_picture =
        d.z() > 0.0 && 2.0 * std::abs(at.x()) < place.width && 2.0 * std::abs(at.y()) < place.height;
    if (in_picture) {
      draw_ring(image, place.x + place.width / 2 + static_cast<int>(at.x()),
                place.y + place.height / 2 + static_cast<int>(at.y()), pen);
    }
    draw_text_box(image, place.x, place.y, TextAnchor::kLeft, picked_->lines, pen);
  }
  if (help_) draw_text_box(image, place.x + place.width, place.y, TextAnchor::kRight, kHelp, pen);
  const std::string status =
      message_.empty() ? fmt::format("layer {} of {}     h: help", layer_ + 1, scene_.layers.size()) : message_;
  draw_text(image, place.x, place.y + place.height + pen.px(14), status, pen.small_text_px(), pen.ink);
}

Image ViewerModel::draw(bool moving) {
  Image image = figure(moving);
  draw_marks(image);
  return image;
}

Image ViewerModel::draw_plain() { return figure(false); }

std::string ViewerModel::title() const { return fmt::format("{} - {}", scene_.title, layer().title); }

}  // namespace cmap
