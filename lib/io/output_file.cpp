#include "cmap/io/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, int error) {
  throw UsageError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(error)));
}

/// A device, a pipe, or a name like /dev/stdout: nothing may be renamed over it.
bool is_written_directly(const fs::path& path) {
  const std::string text = path.string();
  if (text.starts_with("/dev/") || text.starts_with("/proc/")) return true;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

/// Where a symbolic link leads, so that the link itself stays.
fs::path follow_link(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  const fs::path target = fs::weakly_canonical(path, error);
  return error ? path : target;
}

/// Creates a file beside `path` under a name that no one else has.
int create_beside(const fs::path& path, fs::path& temporary) {
  static std::atomic<unsigned> counter{0};
  constexpr mode_t kMode = 0666;
  for (;;) {
    temporary = path.parent_path() / fmt::format(".{}.{}-{}.tmp", path.filename().string(), ::getpid(), counter++);
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
}

}  // namespace

OutputFile::OutputFile(fs::path path) : path_(is_written_directly(path) ? path : follow_link(path)) {
  struct stat existing {};
  const bool exists = ::stat(path_.c_str(), &existing) == 0;
  if (exists && S_ISDIR(existing.st_mode)) fail(path_, EISDIR);
  // Renaming over a protected file would succeed; whoever protected it did not mean that.
  if (exists && ::access(path_.c_str(), W_OK) != 0) fail(path_, errno);
  if (is_written_directly(path_)) {
    file_ = std::fopen(path_.c_str(), "wb");
    if (file_ == nullptr) fail(path_, errno);
    return;
  }
  const int descriptor = create_beside(path_, temporary_);
  if (descriptor < 0) fail(path_, errno);
  if (exists) (void)::fchmod(descriptor, existing.st_mode & 07777);
  file_ = ::fdopen(descriptor, "wb");
  if (file_ == nullptr) {
    const int error = errno;
    ::close(descriptor);
    ::unlink(temporary_.c_str());
    fail(path_, error);
  }
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::write(const void* data, std::size_t bytes) {
  if (std::fwrite(data, 1, bytes, file_) != bytes) fail(path_, errno);
}

void OutputFile::finish() {
  if (std::fflush(file_) != 0) fail(path_, errno);
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail(path_, errno);
}

void OutputFile::commit() {
  if (file_ != nullptr) finish();
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  temporary_.clear();
}

void OutputFiles::add(const fs::path& path, const std::function<void(OutputFile&)>& write) {
  if (path.empty()) return;
  write(files_.emplace_back(path));
  files_.back().finish();
}

void OutputFiles::commit() {
  for (OutputFile& file : files_) file.commit();
}

void require_writable(const fs::path& path) {
  std::error_code ignored;  // what else is wrong with the name is told below
  if (fs::is_directory(path, ignored)) fail(path, EISDIR);
  if (!path.empty() && !is_written_directly(path)) const OutputFile created_and_removed(path);
}

}  // namespace cmap
