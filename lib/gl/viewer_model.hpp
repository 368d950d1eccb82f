#pragma once

#include <map>
#include <optional>

#include "cmap/gl/orbit_camera.hpp"
#include "cmap/gl/viewer.hpp"
#include "coarse_points.hpp"

namespace cmap {

/// What the viewer shows and how it answers to keys and mouse, without any window. Pixels are from the top left.
class ViewerModel {
 public:
  /// The scene must stay alive.
  explicit ViewerModel(const ViewerScene& scene);

  enum class Answer { kNothing, kRedraw, kSave, kQuit };

  /// A key by its name in X ("1", "plus", "Escape"); p is left to pick().
  Answer press(std::string_view key);

  /// The mouse moved by this much with a button held.
  enum class Drag { kTurn, kPan, kZoom };
  void drag(Drag what, int right_px, int down_px);
  void zoom(double factor);
  void resize(int width_px, int height_px);

  /// Looks up the point under this pixel, or the nearest one within a few pixels. Returns its description; empty where
  /// there is none.
  std::vector<std::string> pick(int x, int y);

  /// The picture now; `moving` makes it fast rather than fine.
  Image draw(bool moving);

  /// The picture alone, as it would be saved: without marks and help.
  Image draw_plain();

  /// A line that the picture shows until the next key.
  void say(std::string message) { message_ = std::move(message); }

  std::string title() const;

 private:
  struct Picked {
    const PointBlocks* points;
    std::size_t slot;
    std::vector<std::string> lines;
  };

  const Layer& layer() const { return scene_.layers[layer_]; }
  Image figure(bool moving);
  const PixelMap& seen(const PointBlocks& points, const Projection& projection, const SplatOptions& options);
  void forget_view() { seen_.clear(); }
  void show_layer(std::size_t layer);
  void draw_marks(Image& image) const;

  const ViewerScene& scene_;
  OrbitCamera orbit_;
  FigureOptions options_;
  std::size_t layer_ = 0;
  bool help_ = false;
  std::string message_;
  std::optional<Picked> picked_;
  std::map<const PointBlocks*, CoarsePoints> coarse_;
  std::map<const PointBlocks*, PixelMap> seen_;  ///< fine pictures of the maps from where the camera is now
};

}  // namespace cmap
