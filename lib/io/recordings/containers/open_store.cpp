#include <algorithm>

#include "bytes/file_start.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/recording.hpp"
#include "recordings/containers/merged_store.hpp"
#include "recordings/containers/ros1_store.hpp"
#include "recordings/containers/rosbag2_metadata.hpp"
#include "recordings/containers/sqlite_store.hpp"
#include "recordings/mcap/mcap_records.hpp"
#include "recordings/mcap/mcap_store.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

enum class Container { kNone, kRos1, kMcap, kSqlite };

constexpr std::string_view kRos1Magic = "#ROSBAG V";
constexpr std::string_view kSqliteMagic{"SQLite format 3\0", 16};
constexpr std::string_view kZstdMagic = "\x28\xB5\x2F\xFD";

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// SQLite keeps the text of CREATE TABLE in its first page, where rosbag2 leaves it.
Container container_of(std::string_view start) {
  if (start.starts_with(kRos1Magic)) return Container::kRos1;
  if (start.starts_with(mcap::kMagic)) return Container::kMcap;
  const bool has_tables =
      start.find("messages(") != std::string_view::npos || start.find("messages (") != std::string_view::npos;
  if (start.starts_with(kSqliteMagic) && has_tables) return Container::kSqlite;
  return Container::kNone;
}

Container container_of(ByteSource& source) { return container_of(text_of(source.peek(ByteSource::kMaxRecordBytes))); }

std::unique_ptr<MessageStore> open_file(const fs::path& path) {
  auto source = std::make_unique<ByteSource>(path);
  const std::string_view start = text_of(source->peek(ByteSource::kMaxRecordBytes));
  switch (container_of(start)) {
    case Container::kRos1:
      if (!start.starts_with("#ROSBAG V2.")) source->fail("a bag of ROS 1 that is older than version 2.0: rosbag fix");
      return open_ros1_bag(path);
    case Container::kMcap:
      return open_mcap(std::move(source));
    case Container::kSqlite:
      return open_sqlite(path);
    case Container::kNone:
      break;
  }
  if (start.starts_with(kZstdMagic)) {
    throw UnsupportedError(path.string() +
                           ": a file packed by zstd as a whole; unpack it first (zstd -d), or `ros2 bag convert`");
  }
  source->fail("is no recording (a ROS 1 bag, MCAP, or SQLite with the tables of rosbag2)");
}

std::unique_ptr<MessageStore> open_folder(const fs::path& folder) {
  const fs::path path = folder / "metadata.yaml";
  const Rosbag2Metadata metadata = read_rosbag2_metadata(path);
  // Messages that are packed one by one are told by how they begin.
  if (metadata.compression_mode == "FILE" || metadata.compression_mode == "file") {
    throw UnsupportedError(
        fmt::format("{}: files packed by {} as a whole are not read; `ros2 bag convert` unpacks them, and "
                    "MCAP's own compression is read",
                    path.string(), metadata.compression));
  }
  std::vector<std::unique_ptr<MessageStore>> parts;
  for (const fs::path& file : metadata.files) parts.push_back(open_file(file));
  return merge_stores(std::move(parts));
}

}  // namespace

bool is_recording(const fs::path& path) {
  if (is_folder(path)) return is_file(path / "metadata.yaml");
  if (!is_file(path)) return false;
  std::error_code unknown;
  if (fs::file_size(path, unknown) == 0 || unknown) return false;
  ByteSource source(path);
  return container_of(source) != Container::kNone;
}

std::unique_ptr<MessageStore> open_message_store(const fs::path& path) {
  if (!is_folder(path)) return open_file(path);
  if (is_file(path / "metadata.yaml")) return open_folder(path);
  throw InputError(path.string() + ": a folder without metadata.yaml is no recording of rosbag2");
}

}  // namespace cmap
