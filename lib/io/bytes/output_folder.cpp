#include "cmap/io/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/io/stop_signals.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

/// Says of a folder that it is an unfinished one of ours, which may be thrown away.
constexpr const char* kMark = ".unfinished";

[[noreturn]] void fail(const fs::path& path, std::string_view reason) {
  throw OutputError(fmt::format("{}: cannot be written: {}", path.string(), reason));
}

/// True if it was made, false if it was there.
bool made_folder(const fs::path& path, const fs::path& for_whom) {
  std::error_code error;
  const bool made = fs::create_directory(path, error);
  if (error) fail(for_whom, error.message());
  return made;
}

void require_free(const fs::path& path) {
  if (fs::exists(fs::symlink_status(path))) fail(path, "it is already there");
}

/// Empties what a run that was stopped has left; throws where it is anything else.
void take_over(const fs::path& partial, const fs::path& path) {
  std::error_code error;
  std::vector<fs::path> rest;
  for (auto entry = fs::directory_iterator(partial, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    rest.push_back(entry->path());
  }
  if (error) fail(partial, error.message());
  const auto is_mark = [](const fs::path& entry) { return entry.filename() == kMark; };
  if (!rest.empty() && std::ranges::none_of(rest, is_mark)) {
    fail(path, fmt::format("{} is there, and is not what a run that was stopped has left", partial.string()));
  }
  for (const fs::path& entry : rest) {
    if (!is_mark(entry)) fs::remove_all(entry, error);
    if (error) fail(entry, error.message());
  }
}

void mark(const fs::path& partial) {
  const fs::path path = partial / kMark;
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(path, std::strerror(errno));
  ::close(descriptor);
}

/// Makes the partial folder, or takes over that of a stopped run, and locks it.
FolderLock claim(const fs::path& partial, const fs::path& path) {
  for (;;) {
    require_free(path);
    const bool made = made_folder(partial, path);
    FolderLock lock(partial);
    // Between making and locking, another program may have finished or given up.
    if (lock.is_held() && !lock.is_of(partial)) continue;
    if (!made && !lock.is_held()) {
      fail(path, fmt::format("{} is there: left by a run that was stopped, or still in use", partial.string()));
    }
    take_over(partial, path);
    mark(partial);
    return lock;
  }
}

}  // namespace

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

FolderLock::FolderLock(const fs::path& folder) {
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) fail(folder, std::strerror(errno));
  bool is_taken = true;
  // The last process of a run that was killed holds the lock a moment longer.
  constexpr int kAttempts = 20;
  for (int i = 0; is_taken && i < kAttempts; ++i) {
    if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    is_taken = errno == EWOULDBLOCK;
  }
  ::close(std::exchange(descriptor_, -1));
  if (is_taken) fail(folder, "another program is writing into it");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

bool FolderLock::is_of(const fs::path& folder) const {
  struct stat locked {
  }, named{};
  return ::fstat(descriptor_, &locked) == 0 && ::stat(folder.c_str(), &named) == 0 && locked.st_dev == named.st_dev &&
         locked.st_ino == named.st_ino;
}

OutputFolder::OutputFolder(fs::path path) {
  path_ = path.has_filename() ? std::move(path) : path.parent_path();  // "name/" is "name"
  fs::path partial = path_;
  partial += ".partial";
  lock_ = claim(partial, path_);
  partial_ = std::move(partial);
  remove_when_stopped(partial_);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (partial_.empty()) return;
  fs::remove_all(partial_, ignored);
  keep_when_stopped(partial_);
}

fs::path OutputFolder::subfolder(const fs::path& name) const {
  fs::path folder = partial_ / name;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail(folder, error.message());
  return folder;
}

void OutputFolder::commit() {
  require_free(path_);
  const SignalsWait until_done;
  std::error_code error;
  fs::rename(partial_, path_, error);
  if (error) fail(path_, error.message());
  keep_when_stopped(partial_);
  partial_.clear();
  fs::remove(path_ / kMark, error);  // last: whoever is killed before leaves a rest that is known as one
}

}  // namespace cmap
