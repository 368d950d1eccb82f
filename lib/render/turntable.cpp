#include "cmap/render/turntable.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <functional>
#include <numbers>

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/output_folder.hpp"
#include "video_file.hpp"

namespace cmap {
namespace {

namespace fs = std::filesystem;

using FrameSink = std::function<void(const Image&, std::size_t index)>;

void draw_frames(std::span<const Layer> layers, std::span<const Camera> cameras, const FigureOptions& options,
                 const FrameSink& take) {
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    report_progress("frames", static_cast<double>(i) / static_cast<double>(cameras.size()));
    take(draw_figure(layers, cameras[i], options), i);
  }
}

/// A trailing slash says that it is a folder.
fs::path without_slash(const fs::path& name) { return name.has_filename() ? name : name.parent_path(); }

void write_folder(const fs::path& name, const std::function<void(const FrameSink&)>& draw) {
  OutputFolder folder(name);
  draw([&](const Image& image, std::size_t i) {
    const fs::path frame = folder.partial() / fmt::format("frame_{:04}.png", i);
    OutputFile file(frame);
    write_image(image, frame, file);
    file.commit();
  });
  folder.commit();
}

void write_video(const fs::path& name, const FigureOptions& options,
                 const std::function<void(const FrameSink&)>& draw) {
  OutputFile file(name);
  VideoWriter video(name, file.path_for_writer(), options.width_px, options.height_px, kTurntableFramesPerSecond);
  draw([&](const Image& image, std::size_t) { video.add(image); });
  video.finish();
  file.commit();
}

}  // namespace

std::vector<Camera> turntable_cameras(const Camera& camera, int n_frames) {
  std::vector<Camera> cameras;
  for (int i = 0; i < n_frames; ++i) {
    const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * i / n_frames, Eigen::Vector3d::UnitZ());
    cameras.push_back(camera);
    cameras.back().position = camera.target + turn * (camera.position - camera.target);
    cameras.back().up = turn * camera.up;
  }
  return cameras;
}

void check_turntable_name(const fs::path& name) {
  const fs::path folder = without_slash(name);
  if (name == kStandardStream) throw UsageError("-: a turntable needs a name");
  if (is_video_name(folder)) return require_video_program();
  if (folder.has_extension()) {
    throw UsageError(
        fmt::format("{}: a turntable is a video, .mp4 or .gif, or a folder without an extension", name.string()));
  }
  if (is_there(folder)) throw OutputError(fmt::format("{}: exists already", name.string()));
}

void write_turntable(std::span<const Layer> layers, std::span<const Camera> cameras, const FigureOptions& options,
                     const fs::path& name, const Execution& execution) {
  const ExecutionScope scope(execution);
  check_turntable_name(name);
  const auto draw = [&](const FrameSink& take) { draw_frames(layers, cameras, options, take); };
  is_video_name(name) ? write_video(name, options, draw) : write_folder(without_slash(name), draw);
}

}  // namespace cmap
