#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "cmap/core/error.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap::testing {

/// A folder of its own for each test, removed at the end.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "cmap-io-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = pattern;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(std::string_view name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Bytes of a file, put together by hand.
class Bytes {
 public:
  explicit Bytes(std::string_view text = {}, bool big_endian = false) : bytes_(text), big_endian_(big_endian) {}

  template <class T, class... More>
  Bytes& put(T value, More... more) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (big_endian_) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
    if constexpr (sizeof...(More) > 0) put(more...);
    return *this;
  }
  template <class T>
  Bytes& set(std::size_t place, T value) {
    std::memcpy(bytes_.data() + place, &value, sizeof(T));
    return *this;
  }
  Bytes& text(std::string_view text) {
    bytes_ += text;
    return *this;
  }
  const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
  bool big_endian_;
};

using U8 = std::uint8_t;
using U16 = std::uint16_t;

/// A file with this content, read.
inline PointCloudFile read_content(std::string_view name, std::string_view bytes, const ReadOptions& options = {}) {
  const TempFolder folder;
  return read_point_cloud(folder.write(name, bytes), options);
}

/// What the reader says about a file with this content; empty if it reads it.
inline std::string refusal(std::string_view name, std::string_view bytes) {
  try {
    read_content(name, bytes);
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_THAT(message, ::testing::HasSubstr(std::string(name))) << "every message names the file";
    return message;
  }
  return {};
}

inline Eigen::Vector3d point(const PointCloudFile& file, std::size_t i) { return file.cloud.world(i); }

/// Positions bit by bit, and colors.
inline void expect_same_cloud(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.origin, b.origin);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(0, std::memcmp(a.positions.data(), b.positions.data(), a.size() * sizeof(Eigen::Vector3f)));
  EXPECT_EQ(a.colors, b.colors);
}

inline std::string all_notes(const PointCloudFile& file) {
  std::string notes;
  for (const std::string& note : file.info.notes) notes += note + "\n";
  return notes;
}

}  // namespace cmap::testing
