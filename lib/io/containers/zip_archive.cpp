#include "containers/zip_archive.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"

namespace cmap {
namespace {

constexpr std::uint32_t kEndSignature = 0x06054b50, kEnd64Signature = 0x06064b50, kLocator64Signature = 0x07064b50;
constexpr std::uint32_t kEntrySignature = 0x02014b50, kLocalSignature = 0x04034b50;
constexpr std::size_t kEndBytes = 22, kEnd64Bytes = 56, kLocator64Bytes = 20, kEntryBytes = 46, kLocalBytes = 30;
constexpr std::uint32_t kSeeZip64 = 0xffffffff;
constexpr std::uint64_t kMaxDeflateRatio = 1032;
constexpr std::uint16_t kStored = 0, kDeflated = 8, kEncrypted = 1;

template <class T>
T number_at(std::span<const std::byte> bytes, std::size_t place) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    value = static_cast<T>(value | static_cast<T>(std::to_integer<T>(bytes[place + i]) << (8 * i)));
  }
  return value;
}

struct Directory {
  std::uint64_t entries, bytes, offset;
};

/// Where the end record begins, which a comment may follow; npos: nowhere.
std::size_t find_end_record(std::span<const std::byte> tail) {
  for (std::size_t place = tail.size() - kEndBytes + 1; place-- > 0;) {
    if (number_at<std::uint32_t>(tail, place) != kEndSignature) continue;
    if (place + kEndBytes + number_at<std::uint16_t>(tail, place + 20) == tail.size()) return place;
  }
  return std::string::npos;
}

/// Sizes and offset that do not fit into 32 bits stand in an extra field, in this order, those alone that do not.
/// False where one of them is missing.
bool read_zip64_extra(std::span<const std::byte> extra, ZipMember& member) {
  std::uint64_t* const wide[] = {&member.bytes, &member.compressed_bytes, &member.header_offset};
  const auto is_missing = [](const std::uint64_t* value) { return *value == kSeeZip64; };
  if (std::none_of(std::begin(wide), std::end(wide), is_missing)) return true;
  while (extra.size() >= 4) {
    const auto id = number_at<std::uint16_t>(extra, 0), length = number_at<std::uint16_t>(extra, 2);
    if (length > extra.size() - 4) return false;
    std::span<const std::byte> content = extra.subspan(4, length);
    extra = extra.subspan(4U + length);
    if (id != 1) continue;
    for (std::uint64_t* value : wide) {
      if (!is_missing(value)) continue;
      if (content.size() < 8) return false;
      *value = number_at<std::uint64_t>(content, 0);
      content = content.subspan(8);
    }
    return true;
  }
  return false;
}

/// Cuts the next entry off the front of the directory; false if it is none.
bool take_entry(std::span<const std::byte>& directory, ZipMember& member) {
  if (directory.size() < kEntryBytes || number_at<std::uint32_t>(directory, 0) != kEntrySignature) return false;
  const std::size_t name_bytes = number_at<std::uint16_t>(directory, 28);
  const std::size_t extra_bytes = number_at<std::uint16_t>(directory, 30);
  const std::size_t all_bytes = kEntryBytes + name_bytes + extra_bytes + number_at<std::uint16_t>(directory, 32);
  if (all_bytes > directory.size()) return false;
  member.flags = number_at<std::uint16_t>(directory, 8);
  member.method = number_at<std::uint16_t>(directory, 10);
  member.crc = number_at<std::uint32_t>(directory, 16);
  member.compressed_bytes = number_at<std::uint32_t>(directory, 20);
  member.bytes = number_at<std::uint32_t>(directory, 24);
  member.header_offset = number_at<std::uint32_t>(directory, 42);
  member.name.assign(reinterpret_cast<const char*>(directory.data()) + kEntryBytes, name_bytes);
  const bool complete = read_zip64_extra(directory.subspan(kEntryBytes + name_bytes, extra_bytes), member);
  directory = directory.subspan(all_bytes);
  return complete;
}

/// Inflates as much as fits into `out`; false if the data are damaged or fill less.
bool inflate_into(std::span<const std::byte> deflated, std::span<std::byte> out) {
  if (out.empty()) return true;
  constexpr std::size_t kMostAtOnce = std::numeric_limits<uInt>::max();
  z_stream stream{};
  constexpr int kRawDeflate = -15;
  if (inflateInit2(&stream, kRawDeflate) != Z_OK) return false;
  std::size_t consumed = 0, produced = 0;
  int inflate_state = Z_OK;
  while (inflate_state == Z_OK && (produced < out.size() || consumed < deflated.size())) {
    const std::size_t in_bytes = std::min(kMostAtOnce, deflated.size() - consumed);
    const std::size_t out_bytes = std::min(kMostAtOnce, out.size() - produced);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(deflated.data() + consumed));
    stream.avail_in = static_cast<uInt>(in_bytes);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + produced);
    stream.avail_out = static_cast<uInt>(out_bytes);
    inflate_state = inflate(&stream, Z_NO_FLUSH);
    consumed += in_bytes - stream.avail_in;
    produced += out_bytes - stream.avail_out;
  }
  inflateEnd(&stream);
  return produced == out.size() &&
         (inflate_state == Z_STREAM_END || inflate_state == Z_OK || inflate_state == Z_BUF_ERROR);
}

std::uint32_t checksum(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

[[noreturn]] void fail(const std::string& archive, std::string_view reason) {
  throw InputError(fmt::format("{}: {}", archive, reason));
}

[[noreturn]] void fail(const std::string& archive, const ZipMember& member, std::string_view reason) {
  throw InputError(fmt::format("{}: member {}: {}", archive, member.name, reason));
}

}  // namespace

ZipArchive::ZipArchive(const std::filesystem::path& path) : name_(path.string()) {
  if (!is_there(path)) fail(name_, "no such file");
  if (!is_file(path)) fail(name_, "is no regular file");
  file_.open(path, std::ios::binary);
  if (!file_) fail(name_, "cannot be opened");
  size_ = std::filesystem::file_size(path);
  read_directory();
}

ZipArchive::ZipArchive(std::string name, std::span<const std::byte> memory)
    : name_(std::move(name)), memory_(memory), size_(memory.size()) {
  read_directory();
}

Array<std::byte> ZipArchive::read_at(std::uint64_t offset, std::uint64_t n, std::string_view what) const {
  if (offset > size_ || n > size_ - offset) {
    fail(name_,
         fmt::format("truncated: {} at byte {} takes {} bytes, but the file ends at byte {}", what, offset, n, size_));
  }
  Array<std::byte> bytes(n);
  if (file_.is_open()) {
    file_.seekg(static_cast<std::streamoff>(offset));
    file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(n));
    if (!file_) fail(name_, fmt::format("reading {} at byte {} failed", what, offset));
  } else if (n > 0) {
    std::memcpy(bytes.data(), memory_.data() + offset, n);
  }
  return bytes;
}

void ZipArchive::read_directory() {
  constexpr std::uint64_t kLongestTail = kEndBytes + 0xffff;
  const std::uint64_t tail_bytes = std::min(size_, kLongestTail);
  const Array<std::byte> tail = read_at(size_ - tail_bytes, tail_bytes, "the end of a ZIP file");
  const std::size_t end = tail.size() < kEndBytes ? std::string::npos : find_end_record(tail);
  if (end == std::string::npos) fail(name_, "truncated, or no ZIP file: the central directory at its end is missing");
  Directory directory{number_at<std::uint16_t>(tail, end + 10), number_at<std::uint32_t>(tail, end + 12),
                      number_at<std::uint32_t>(tail, end + 16)};
  if (end >= kLocator64Bytes && number_at<std::uint32_t>(tail, end - kLocator64Bytes) == kLocator64Signature) {
    const auto record =
        read_at(number_at<std::uint64_t>(tail, end - kLocator64Bytes + 8), kEnd64Bytes, "the ZIP64 end record");
    if (number_at<std::uint32_t>(record, 0) != kEnd64Signature) fail(name_, "the ZIP64 end record is damaged");
    directory = {number_at<std::uint64_t>(record, 32), number_at<std::uint64_t>(record, 40),
                 number_at<std::uint64_t>(record, 48)};
  }
  const Array<std::byte> entries = read_at(directory.offset, directory.bytes, "the central directory");
  std::span<const std::byte> rest(entries);
  for (std::uint64_t i = 0; i < directory.entries; ++i) {
    ZipMember member;
    if (!take_entry(rest, member)) fail(name_, fmt::format("entry {} of the central directory is damaged", i + 1));
    if (find(member.name) != nullptr) fail(name_, member, "is there twice");
    members_.push_back(std::move(member));
  }
}

const ZipMember* ZipArchive::find(std::string_view member_name) const {
  const auto found =
      std::find_if(members_.begin(), members_.end(), [&](const auto& m) { return m.name == member_name; });
  return found == members_.end() ? nullptr : &*found;
}

std::uint64_t ZipArchive::data_offset(const ZipMember& member) const {
  if ((member.flags & kEncrypted) != 0) fail(name_, member, "is encrypted");
  if (member.method != kStored && member.method != kDeflated) {
    fail(name_, member,
         fmt::format("is compressed with method {}; stored and deflated members can be read", member.method));
  }
  const auto local = read_at(member.header_offset, kLocalBytes, fmt::format("the header of {}", member.name));
  if (number_at<std::uint32_t>(local, 0) != kLocalSignature)
    fail(name_, member, "has no header where the directory says");
  return member.header_offset + kLocalBytes + number_at<std::uint16_t>(local, 26) + number_at<std::uint16_t>(local, 28);
}

Array<std::byte> ZipArchive::read(const ZipMember& member) const {
  // Sizes are checked before memory is taken for them.
  if (member.compressed_bytes > size_) fail(name_, member, "truncated: is longer than the file");
  const bool stored = member.method == kStored;
  if (stored ? member.bytes != member.compressed_bytes : member.bytes / kMaxDeflateRatio > member.compressed_bytes) {
    fail(name_, member, fmt::format("{} bytes cannot hold its {}", member.compressed_bytes, member.bytes));
  }
  Array<std::byte> content = read_at(data_offset(member), member.compressed_bytes, member.name);
  if (!stored) {
    Array<std::byte> inflated(member.bytes);
    if (!inflate_into(content, inflated)) fail(name_, member, "the compressed data are damaged");
    content = std::move(inflated);
  }
  if (checksum(content) != member.crc) fail(name_, member, "is damaged: its checksum is another");
  return content;
}

std::string ZipArchive::read_start(const ZipMember& member, std::size_t n) const {
  const std::uint64_t compressed_bytes = std::min<std::uint64_t>(member.compressed_bytes, n + n / 4 + 64);
  const Array<std::byte> content = read_at(data_offset(member), compressed_bytes, member.name);
  std::string start(std::min<std::uint64_t>(n, member.bytes), '\0');
  const auto out = std::as_writable_bytes(std::span(start));
  if (member.method == kDeflated) {
    (void)inflate_into(content, out);
  } else {
    std::copy_n(content.begin(), std::min(content.size(), out.size()), out.begin());
  }
  return start;
}

}  // namespace cmap
