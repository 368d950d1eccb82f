#include "video_file.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/io/stop_signals.hpp"
#include "file_extension.hpp"

extern char** environ;

namespace cmap {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "ffmpeg";

void add_words(std::vector<std::string>& words, const std::string& text) {
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
}

constexpr const char* kGif = "-filter_complex split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=none -f gif";

/// Players know 4:2:0 alone, which needs even sizes, and guess the color matrix by the size where it is not said.
constexpr const char* kMp4 =
    "-vf pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,"
    "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int,format=yuv420p "
    "-colorspace bt709 -color_primaries bt709 -color_trc bt709 -color_range tv "
    "-c:v libx264 -threads 2 -crf 18 -movflags +faststart -f mp4";

/// A fixed number of threads and no time stamps: the same bytes from every run.
std::vector<std::string> arguments_for(const fs::path& name, const fs::path& path, int width_px, int height_px,
                                       int frames_per_second) {
  std::vector<std::string> arguments{kProgram};
  add_words(arguments, fmt::format("-loglevel error -y -f rawvideo -pix_fmt rgb24 -s {}x{} -r {} -i pipe:0", width_px,
                                   height_px, frames_per_second));
  add_words(arguments, lower_case_extension(name) == ".gif" ? kGif : kMp4);
  add_words(arguments, "-fflags +bitexact -flags:v +bitexact");
  arguments.push_back(path.string());
  return arguments;
}

/// Starts the program with `input` as its standard input.
pid_t start(std::vector<std::string> arguments, int input) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  pid_t process = -1;
  if (::posix_spawnp(&process, kProgram, &actions, nullptr, argv.data(), environ) != 0) process = -1;
  posix_spawn_file_actions_destroy(&actions);
  return process;
}

}  // namespace

bool is_video_name(const fs::path& name) {
  const std::string extension = lower_case_extension(name);
  return extension == ".mp4" || extension == ".gif";
}

void require_video_program() {
  std::istringstream folders(std::getenv("PATH") == nullptr ? "" : std::getenv("PATH"));
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((fs::path(folder) / kProgram).c_str(), X_OK) == 0) return;
  }
  throw UsageError("videos need the program ffmpeg (apt-get install ffmpeg); a folder of frames does not");
}

VideoWriter::VideoWriter(fs::path name, const fs::path& path, int width_px, int height_px, int frames_per_second)
    : name_(std::move(name)) {
  // A socket, as writing into a pipe that the other end has closed would end this program.
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail();
  pipe_ = ends[0];
  process_ = start(arguments_for(name_, path, width_px, height_px, frames_per_second), ends[1]);
  ::close(ends[1]);
  if (process_ < 0) {
    ::close(pipe_);
    fail();
  }
  end_when_stopped(process_);
}

VideoWriter::~VideoWriter() {
  if (pipe_ >= 0) ::close(pipe_);
  if (process_ < 0) return;
  ::kill(process_, SIGTERM);
  ::waitpid(process_, nullptr, 0);
  forget_child(process_);
}

void VideoWriter::add(const Image& image) {
  std::string bytes;
  bytes.reserve(3 * image.pixels.size());
  for (const Rgba8& pixel : image.pixels) {
    const Rgba8 opaque = over_white(pixel);
    bytes.append(opaque.begin(), opaque.begin() + 3);
  }
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t n = ::send(pipe_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) fail();
    sent += static_cast<std::size_t>(n);
  }
}

void VideoWriter::finish() {
  ::close(pipe_);
  pipe_ = -1;
  int status = 0;
  ::waitpid(process_, &status, 0);
  forget_child(process_);
  process_ = -1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail();
}

void VideoWriter::fail() const { throw OutputError(fmt::format("{}: ffmpeg cannot write it", name_.string())); }

}  // namespace cmap
