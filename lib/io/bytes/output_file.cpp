#include "cmap/io/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/stop_signals.hpp"

namespace cmap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error) {
  const std::string name = path == kStandardStream ? "standard output" : path.string();
  throw OutputError(fmt::format("{}: cannot be written: {}", name, std::strerror(error)));
}

/// A device, a pipe, or a name like /dev/stdout: nothing may be renamed over it.
bool is_written_directly(const fs::path& path) {
  const std::string text = path.string();
  if (text == kStandardStream || text.starts_with("/dev/") || text.starts_with("/proc/")) return true;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

std::FILE* open_directly(const fs::path& path) {
  if (path == kStandardStream) {
    const int descriptor = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
    return descriptor < 0 ? nullptr : ::fdopen(descriptor, "wb");
  }
  return std::fopen(path.c_str(), "wbe");
}

// Until commit() the content lies either in a file without a name, which ends with the process and which /proc shows
// under the number of its descriptor, or, where the file system knows no such files, in one with a temporary name.

constexpr mode_t kMode = 0666;
constexpr int kManyOpen = 256;  ///< a file without a name costs a descriptor to its end

fs::path place_in_proc(int descriptor) { return fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor); }

bool is_nameless(const fs::path& temporary) { return temporary.string().starts_with("/proc/"); }

int descriptor_of(const fs::path& nameless) { return std::stoi(nameless.filename().string()); }

/// A name beside `path` that no one else has.
fs::path name_beside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  return path.parent_path() / fmt::format(".{}.{}-{}.tmp", path.filename().string(), ::getpid(), counter++);
}

/// Returns a descriptor for writing; below zero, with errno set, where the folder takes no file.
int create_beside(const fs::path& path, fs::path& temporary) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int nameless = ::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, kMode);
  temporary = place_in_proc(nameless);
  if (nameless >= 0 && nameless < kManyOpen && ::access(temporary.c_str(), F_OK) == 0) {
    const int writer = ::fcntl(nameless, F_DUPFD_CLOEXEC, 0);
    if (writer >= 0) return writer;
  }
  if (nameless >= 0) ::close(nameless);
  for (;;) {
    temporary = name_beside(path);
    remove_when_stopped(temporary);
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
    if (descriptor >= 0) return descriptor;
    const int error = errno;
    keep_when_stopped(temporary);
    errno = error;
    if (error != EEXIST) return descriptor;
  }
}

/// Removes what was not committed.
void discard(const fs::path& temporary) {
  if (is_nameless(temporary)) {
    ::close(descriptor_of(temporary));
  } else {
    ::unlink(temporary.c_str());
    keep_when_stopped(temporary);
  }
}

bool link_to(const fs::path& nameless, const fs::path& path) {
  return ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

/// Gives a file without a name one beside `path`, as linking replaces nothing.
bool name_it_beside(fs::path& temporary, const fs::path& path) {
  for (;;) {
    const fs::path named = name_beside(path);
    remove_when_stopped(named);
    if (link_to(temporary, named)) {
      discard(temporary);
      temporary = named;
      return true;
    }
    const int error = errno;
    keep_when_stopped(named);
    errno = error;
    if (error != EEXIST) return false;
  }
}

}  // namespace

OutputFile::OutputFile(fs::path path) : path_(std::move(path)) {
  if (is_written_directly(path_)) {
    file_ = open_directly(path_);
    if (file_ == nullptr) fail(path_, errno);
    return;
  }
  std::error_code ignored;
  if (fs::is_symlink(path_, ignored)) path_ = place_of_file(path_);  // so that the link itself stays
  struct stat existing {};
  const bool exists = ::stat(path_.c_str(), &existing) == 0;
  // Renaming over a protected file would succeed; whoever protected it did not mean that.
  if (exists && ::access(path_.c_str(), W_OK) != 0) fail(path_, errno);
  const int descriptor = create_beside(path_, temporary_);
  if (descriptor < 0) fail(path_, errno);
  if (exists) (void)::fchmod(descriptor, existing.st_mode & 07777);
  file_ = ::fdopen(descriptor, "wb");
  if (file_ == nullptr) {
    const int error = errno;
    ::close(descriptor);
    discard(temporary_);
    fail(path_, error);
  }
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (!temporary_.empty()) discard(temporary_);
}

// Whoever closes the other end of a pipe has read enough: no error, and nothing to say.

void OutputFile::write(const void* data, std::size_t bytes) {
  if (std::fwrite(data, 1, bytes, file_) != bytes && errno != EPIPE) fail(path_, errno);
}

void OutputFile::finish() {
  if (std::fflush(file_) != 0 && errno != EPIPE) fail(path_, errno);
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0 && errno != EPIPE) fail(path_, errno);
}

void OutputFile::commit() {
  if (file_ != nullptr) finish();
  if (temporary_.empty()) return;
  const SignalsWait until_done;
  if (is_nameless(temporary_)) {
    if (link_to(temporary_, path_)) {
      discard(temporary_);
      temporary_.clear();
      return;
    }
    if (errno != EEXIST || !name_it_beside(temporary_, path_)) fail(path_, errno);
  }
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  keep_when_stopped(temporary_);
  temporary_.clear();
}

void OutputFiles::add(const fs::path& path, const std::function<void(OutputFile&)>& write) {
  if (path.empty()) return;
  write(files_.emplace_back(path));
  files_.back().finish();
}

void OutputFiles::commit() {
  const SignalsWait until_done;
  for (OutputFile& file : files_) file.commit();
}

void require_writable(const fs::path& path) {
  std::error_code ignored;  // what else is wrong with the name is told below
  if (fs::is_directory(path, ignored)) fail(path, EISDIR);
  if (!path.empty() && !is_written_directly(path)) const OutputFile created_and_removed(path);
}

}  // namespace cmap
