#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "cmap/core/array.hpp"

namespace cmap {

struct ZipMember {
  std::string name;
  std::uint16_t flags = 0;
  std::uint16_t method = 0;  ///< 0 stored, 8 deflated
  std::uint32_t crc = 0;
  std::uint64_t compressed_bytes = 0;
  std::uint64_t bytes = 0;
  std::uint64_t header_offset = 0;
};

/// A ZIP file (PKWARE APPNOTE 6.3, with ZIP64) whose members are stored or deflated, as numpy.savez writes them. The
/// central directory is read and checked when it is opened, a member's sizes and checksum when the member is read.
/// Every error is an InputError that names file and member. Not thread-safe: a file has one place to read from.
class ZipArchive {
 public:
  explicit ZipArchive(const std::filesystem::path& path);
  /// Bytes in memory, which must outlive the archive; `name` stands for the path in messages.
  ZipArchive(std::string name, std::span<const std::byte> memory);

  const std::string& name() const { return name_; }
  /// In the order of the central directory.
  const std::vector<ZipMember>& members() const { return members_; }
  /// None: nullptr.
  const ZipMember* find(std::string_view member_name) const;
  /// The member's content.
  Array<std::byte> read(const ZipMember& member) const;
  /// Its first bytes, at most n, for a look at what it is; the checksum is not known then.
  std::string read_start(const ZipMember& member, std::size_t n) const;

 private:
  void read_directory();
  std::uint64_t data_offset(const ZipMember& member) const;
  Array<std::byte> read_at(std::uint64_t offset, std::uint64_t n, std::string_view what) const;

  std::string name_;
  std::span<const std::byte> memory_;
  mutable std::ifstream file_;  ///< where there is no memory
  std::uint64_t size_ = 0;
  std::vector<ZipMember> members_;
};

}  // namespace cmap
