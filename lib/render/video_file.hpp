#pragma once

#include <sys/types.h>

#include <filesystem>

#include "cmap/render/image.hpp"

namespace cmap {

/// .mp4 (H.264) or .gif
bool is_video_name(const std::filesystem::path& name);

/// Throws UsageError that says what to install where the program ffmpeg is missing.
void require_video_program();

/// Hands pictures of one size to ffmpeg, which writes the video. Videos have no transparency: white shows through.
class VideoWriter {
 public:
  /// `name` tells the format and stands in messages; the video goes to `path`.
  VideoWriter(std::filesystem::path name, const std::filesystem::path& path, int width_px, int height_px,
              int frames_per_second);
  /// Ends ffmpeg where finish() was not reached.
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  void add(const Image& image);

  /// Waits until the video is complete. Throws OutputError where ffmpeg failed; its own message is on stderr.
  void finish();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path name_;
  pid_t process_ = -1;
  int pipe_ = -1;
};

}  // namespace cmap
