#pragma once

#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cmap/io/capture.hpp"
#include "cmap/io/session_file.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {

/// What `action` refuses with; empty if it does not.
inline std::string input_error(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// An NPY file put together by hand, with the spelling that NumPy uses.
inline std::string npy_text(std::string_view descr, std::string_view shape, std::string_view data,
                            std::string_view fortran = "False", int major = 1) {
  std::string header = fmt::format("{{'descr': {}, 'fortran_order': {}, 'shape': {}, }}", descr, fortran, shape);
  const std::size_t start = major == 1 ? 10 : 12;
  header.append(64 - (start + header.size() + 1) % 64, ' ');
  header += '\n';
  Bytes bytes("\x93NUMPY");
  bytes.put(static_cast<U8>(major), U8{0});
  if (major == 1) {
    bytes.put(static_cast<U16>(header.size()));
  } else {
    bytes.put(static_cast<std::uint32_t>(header.size()));
  }
  return bytes.text(header).text(data).str();
}

template <class T>
std::string raw(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline std::string deflated(std::string_view bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::runtime_error("zlib");
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// A ZIP file put together by hand (APPNOTE 4.3), as Python's zipfile writes it.
struct ZipText {
  bool deflate = false;
  bool zip64 = false;  ///< sizes and offsets in the extra fields, as NumPy does beyond 4 GiB
  std::vector<std::pair<std::string, std::string>> members;

  std::string str() const {
    constexpr std::uint32_t kSeeZip64 = 0xffffffff;
    Bytes file, directory;
    for (const auto& [name, content] : members) {
      const std::string packed = deflate ? deflated(content) : content;
      const auto crc = static_cast<std::uint32_t>(
          ::crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())));
      const auto offset = file.str().size();
      const U16 method = deflate ? 8 : 0;
      const auto narrow = [&](std::size_t value) { return zip64 ? kSeeZip64 : static_cast<std::uint32_t>(value); };
      const auto name_bytes = static_cast<U16>(name.size());
      file.put(std::uint32_t{0x04034b50}, U16{45}, U16{0}, method, U16{0}, U16{0x21}, crc, narrow(packed.size()),
               narrow(content.size()), name_bytes, U16(zip64 ? 20 : 0));
      file.text(name);
      if (zip64) file.put(U16{1}, U16{16}, std::uint64_t{content.size()}, std::uint64_t{packed.size()});
      file.text(packed);
      directory.put(std::uint32_t{0x02014b50}, U16{45}, U16{45}, U16{0}, method, U16{0}, U16{0x21}, crc,
                    narrow(packed.size()), narrow(content.size()), name_bytes, U16(zip64 ? 28 : 0), U16{0}, U16{0},
                    U16{0}, std::uint32_t{0}, narrow(offset));
      directory.text(name);
      if (zip64) {
        directory.put(U16{1}, U16{24}, std::uint64_t{content.size()}, std::uint64_t{packed.size()},
                      std::uint64_t{offset});
      }
    }
    const std::size_t start = file.str().size(), length = directory.str().size();
    file.text(directory.str());
    const auto n = static_cast<U16>(members.size());
    if (zip64) {
      const std::size_t record = file.str().size();
      file.put(std::uint32_t{0x06064b50}, std::uint64_t{44}, U16{45}, U16{45}, std::uint32_t{0}, std::uint32_t{0},
               std::uint64_t{n}, std::uint64_t{n}, std::uint64_t{length}, std::uint64_t{start});
      file.put(std::uint32_t{0x07064b50}, std::uint32_t{0}, std::uint64_t{record}, std::uint32_t{1});
    }
    file.put(std::uint32_t{0x06054b50}, U16{0}, U16{0}, n, n, static_cast<std::uint32_t>(length),
             zip64 ? kSeeZip64 : static_cast<std::uint32_t>(start), U16{0});
    return file.str();
  }
};

/// The files of a session of two frames of 3 x 2 pixels, to be broken one at a time.
struct SessionText {
  std::vector<std::pair<std::string, std::string>> files{
      {"meta.json",
       R"({"version":1,"frames":2,"width":3,"height":2,"pose_convention":"opencv_cam_from_world","depth_type":"z",)"
       R"("intrinsics_pixel_origin":"integer_center"})"},
      {"frames.csv", "index,timestamp_s,image_name,orig_w,orig_h\n0,10.5,a.jpg,30,20\n1,10.75,b.jpg,30,20\n"},
      {"images.npy", npy_text("'|u1'", "(2, 2, 3, 3)", image_bytes())},
      {"depth.npy", npy_text("'<f4'", "(2, 2, 3)", raw(depth()))},
      {"depth_conf.npy", npy_text("'<f4'", "(2, 2, 3)", raw(confidence()))},
      {"extrinsic.npy", npy_text("'<f8'", "(2, 3, 4)", raw(poses()))},
      {"intrinsic.npy", npy_text("'<f8'", "(2, 3, 3)", raw(matrices()))}};

  static std::string image_bytes() {
    std::string bytes;
    for (int i = 0; i < 36; ++i) bytes.push_back(static_cast<char>(7 * i));
    return bytes;
  }
  static std::vector<float> depth() { return {1, 2, 3, 4, 5, 6, 1.5F, 2.5F, 3.5F, 4.5F, 5.5F, 6.5F}; }
  static std::vector<float> confidence() { return {1, 1.25F, 1.5F, 2, 3, 4, 5, 6, 7, 8, 9, 10}; }
  /// Identity, and a quarter turn about z with a shift.
  static std::vector<double> poses() {
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0.5, 1, 0, 0, 0.25, 0, 0, 1, -1};
  }
  static std::vector<double> matrices() { return {4, 0, 1.5, 0, 5, 1, 0, 0, 1, 4.5, 0, 1.5, 0, 5.5, 1, 0, 0, 1}; }

  std::string& operator[](std::string_view name) {
    for (auto& [file, content] : files) {
      if (file == name) return content;
    }
    return files.emplace_back(name, "").second;
  }
  void erase(std::string_view name) {
    std::erase_if(files, [&](const auto& file) { return file.first == name; });
  }
  void write_to(const TempFolder& folder) const {
    for (const auto& [name, content] : files) folder.write(name, content);
  }
  SessionPredictions read() const {
    const TempFolder folder;
    write_to(folder);
    return read_session_predictions(folder.path());
  }
  /// The same as predictions.npz with frames.csv beside it.
  ZipText npz() const {
    ZipText zip;
    for (const auto& [name, content] : files) {
      if (name.ends_with(".npy")) zip.members.emplace_back(name, content);
    }
    return zip;
  }
};

inline constexpr const char* kCaptureJson = R"({
 "version": 1,
 "camera": {"model": "pinhole", "width": 30, "height": 20, "K": [25.5, 26, 14.5, 9.5], "distortion": [0.1, 0, 0, 0]},
 "T_imu_lidar": [[0,-1,0,0.5],[1,0,0,0],[0,0,1,-0.25],[0,0,0,1]],
 "T_lidar_camera": [[0,0,1,0],[-1,0,0,0],[0,-1,0,0],[0,0,0,1]],
 "T_world_imu_start": [[0,-1,0,5],[1,0,0,6],[0,0,1,7],[0,0,0,1]],
 "imu": {"acceleration_unit": "g"},
 "time_offset": {"image_s": 0.5, "imu_s": -0.25}
})";

/// A small capture, to be broken one file at a time.
struct CaptureText {
  std::map<std::string, std::string> files{
      {"capture.json", kCaptureJson},
      {"images.csv", "timestamp_s,file\n1,images/a.jpg\n2.5,images/b.jpg\n"},
      {"images/a.jpg", "not looked at"},
      {"images/b.jpg", "not looked at"},
      {"lidar.csv", "timestamp_s,file\n1.5,lidar/a.pcd\n"},
      {"lidar/a.pcd", "not looked at"},
      {"imu.csv", "timestamp_s,gx,gy,gz,ax,ay,az\n1,0.1,0.2,0.3,0,0,1\n1.5,0,0,0,0.5,0,-1\n"},
      {"lio.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n"}};

  Capture open() const {
    const TempFolder folder;
    write_to(folder.path());
    return open_capture(folder.path());
  }
  void write_to(const std::filesystem::path& folder) const {
    for (const auto& [name, content] : files) {
      std::filesystem::create_directories((folder / name).parent_path());
      std::ofstream(folder / name, std::ios::binary) << content;
    }
  }
};

}  // namespace cmap::testing
