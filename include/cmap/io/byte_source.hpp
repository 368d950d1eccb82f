#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "cmap/core/array.hpp"
#include "cmap/core/error.hpp"
#include "cmap/io/sha256.hpp"

namespace cmap {

/// The bytes of a file in order, through one reused block, hashed on the way if asked for.
///
/// A regular file is never held in memory as a whole; a pipe is, because readers check every count against the size.
class ByteSource {
 public:
  static constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  /// No single record or line may be longer than this; a block is never smaller.
  static constexpr std::size_t kMaxRecordBytes = std::size_t{1} << 16;

  /// Opens a regular file, a pipe, or standard input ("-"). Throws InputError for anything else, and for an empty one.
  explicit ByteSource(const std::filesystem::path& path, bool sha256 = false);
  /// Bytes in memory, which must outlive the source; `name` stands for the path in messages.
  ByteSource(std::string name, std::span<const std::byte> memory, bool sha256 = false,
             std::size_t block_bytes = kMaxRecordBytes);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return position_; }
  std::uint64_t remaining() const { return size_ - position_; }
  std::size_t block_bytes() const { return block_bytes_; }

  /// At least n of the next bytes, fewer only at the end; n <= block_bytes(). Valid until the next peek.
  std::span<const std::byte> peek(std::size_t n) {
    if (window_.size() < n) refill(n);
    return window_;
  }
  /// Steps over n of the bytes that peek() returned.
  void advance(std::size_t n) {
    window_ = window_.subspan(n);
    position_ += n;
  }
  /// Steps over n bytes; `what` names them in the message of a truncated file.
  void skip(std::uint64_t n, std::string_view what);
  /// Copies the next bytes.
  void read(std::span<std::byte> out, std::string_view what);
  /// Copies bytes from anywhere without moving; the number of bytes copied, fewer only at the end.
  std::size_t read_at(std::uint64_t offset, std::span<std::byte> out) const;
  /// Throws InputError unless n bytes are left.
  void require(std::uint64_t n, std::string_view what) const;

  /// Reads to the end; empty unless asked for.
  std::string finish_sha256();

  /// Throws InputError "<name>: <reason>".
  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> reason, Args&&... args) const {
    throw InputError(name_ + ": " + fmt::format(reason, std::forward<Args>(args)...));
  }

 private:
  void refill(std::size_t n);
  std::size_t read_some(std::span<std::byte> out, std::uint64_t offset);
  void spool_pipe();

  std::string name_;
  int file_ = -1;
  std::span<const std::byte> memory_;
  Array<std::byte> spool_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  std::size_t block_bytes_ = kBlockBytes;
  std::unique_ptr<std::byte[]> buffer_;
  std::span<const std::byte> window_;
  std::optional<Sha256> hash_;
};

}  // namespace cmap
