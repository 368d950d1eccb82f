#include "cmap/io/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "cmap/core/execution.hpp"
#include "cmap/io/file_place.hpp"

namespace cmap {

namespace {

/// Standard input may be a socket, which cannot be opened by a name like /dev/stdin.
int open_input(const std::filesystem::path& path) {
  if (path == kStandardStream) return ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0);
  for (;;) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file >= 0 || errno != EINTR) return file;
  }
}

}  // namespace

ByteSource::ByteSource(const std::filesystem::path& path, bool sha256)
    : name_(name_of_input(path)), file_(open_input(path)) {
  if (file_ < 0) {
    if (errno == ENOENT) fail("no such file");
    fail("cannot be opened: {}", std::strerror(errno));
  }
  try {
    struct stat status {};
    if (::fstat(file_, &status) != 0) fail("cannot be examined: {}", std::strerror(errno));
    if (S_ISDIR(status.st_mode)) fail("is a folder, not a file");
    if (S_ISFIFO(status.st_mode) || path == kStandardStream) {
      spool_pipe();
    } else if (S_ISREG(status.st_mode)) {
      size_ = static_cast<std::uint64_t>(status.st_size);
      (void)::posix_fadvise(file_, 0, 0, POSIX_FADV_SEQUENTIAL);
    } else {
      fail("is neither a regular file nor a pipe");
    }
    if (size_ == 0) fail("the file is empty");
    if (sha256) hash_.emplace();
    buffer_ = std::make_unique_for_overwrite<std::byte[]>(block_bytes_);
  } catch (...) {
    ::close(file_);
    throw;
  }
}

ByteSource::ByteSource(std::string name, std::span<const std::byte> memory, bool sha256, std::size_t block_bytes)
    : name_(std::move(name)), memory_(memory), size_(memory.size()) {
  if (size_ == 0) fail("the file is empty");
  if (sha256) hash_.emplace();
  block_bytes_ = std::max(block_bytes, kMaxRecordBytes);
  buffer_ = std::make_unique_for_overwrite<std::byte[]>(block_bytes_);
}

ByteSource::~ByteSource() {
  if (file_ >= 0) ::close(file_);
}

void ByteSource::skip(std::uint64_t n, std::string_view what) {
  require(n, what);
  while (n > 0) {
    const std::size_t step = std::min<std::uint64_t>(n, peek(1).size());
    if (step == 0) require(n, what);
    advance(step);
    n -= step;
  }
}

void ByteSource::read(std::span<std::byte> out, std::string_view what) {
  require(out.size(), what);
  while (!out.empty()) {
    const std::size_t step = std::min(out.size(), peek(1).size());
    if (step == 0) require(out.size(), what);
    std::memcpy(out.data(), window_.data(), step);
    advance(step);
    out = out.subspan(step);
  }
}

std::size_t ByteSource::read_at(std::uint64_t offset, std::span<std::byte> out) const {
  if (offset >= size_ || out.empty()) return 0;  // memcpy takes no null pointer, whatever the size
  out = out.first(std::min<std::uint64_t>(out.size(), size_ - offset));
  if (!memory_.empty()) {
    std::memcpy(out.data(), memory_.data() + offset, out.size());
    return out.size();
  }
  throw_if_stopped();
  std::size_t filled = 0;
  while (filled < out.size()) {
    const ssize_t got = ::pread(file_, out.data() + filled, out.size() - filled, static_cast<off_t>(offset + filled));
    if (got < 0 && errno != EINTR) fail("reading failed at byte {}: {}", offset + filled, std::strerror(errno));
    if (got == 0) break;  // the file became shorter
    if (got > 0) filled += static_cast<std::size_t>(got);
  }
  return filled;
}

void ByteSource::require(std::uint64_t n, std::string_view what) const {
  if (n > remaining()) {
    fail("truncated: {} at byte {} takes {} bytes, but the file ends at byte {}", what, position_, n, size_);
  }
}

std::string ByteSource::finish_sha256() {
  if (!hash_) return {};
  while (!peek(1).empty()) advance(window_.size());
  return hash_->finish();
}

void ByteSource::refill(std::size_t n) {
  std::size_t filled = window_.size();
  if (filled > 0) std::memmove(buffer_.get(), window_.data(), filled);
  while (filled < n && position_ + filled < size_) {
    const std::uint64_t left = size_ - position_ - filled;
    const std::span<std::byte> room{buffer_.get() + filled, std::min<std::uint64_t>(left, block_bytes_ - filled)};
    const std::size_t got = read_some(room, position_ + filled);
    if (got == 0) size_ = position_ + filled;  // the file became shorter while it was read
    if (hash_) hash_->add(room.first(got));
    filled += got;
  }
  window_ = {buffer_.get(), filled};
}

std::size_t ByteSource::read_some(std::span<std::byte> out, std::uint64_t offset) {
  if (!memory_.empty()) {
    const std::size_t n = std::min<std::uint64_t>(out.size(), memory_.size() - offset);
    std::memcpy(out.data(), memory_.data() + offset, n);
    return n;
  }
  throw_if_stopped();
  for (;;) {
    const ssize_t got = ::read(file_, out.data(), out.size());
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) fail("reading failed after byte {}: {}", position_, std::strerror(errno));
  }
}

void ByteSource::spool_pipe() {
  std::size_t filled = 0;
  for (;;) {
    if (filled == spool_.size()) spool_.resize(std::max(kBlockBytes, 2 * spool_.size()));
    const std::size_t got = read_some(std::span(spool_).subspan(filled), filled);
    if (got == 0) break;
    filled += got;
  }
  memory_ = std::span(spool_).first(filled);
  size_ = filled;
}

}  // namespace cmap
