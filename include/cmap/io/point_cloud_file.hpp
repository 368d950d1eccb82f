#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cmap/core/warning.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/output_file.hpp"

namespace cmap {

struct ReadOptions {
  /// Also compute the SHA-256 of the whole file, from the same blocks that are parsed.
  bool sha256 = false;
  bool keep_noise = false;                 ///< LAS: points of the noise classes 7 and 18 too
  std::vector<std::uint8_t> classes = {};  ///< LAS: points of these classes only; empty: of all
};

/// Finite points that a reader does not hand on, and why.
struct LeftOut {
  std::string reason;  ///< "withheld", "noise", "no return", ...
  std::uint64_t n = 0;
};

/// What a reader found out about a file.
struct FileInfo {
  std::string path;          ///< as given
  std::string format;        ///< for people: "PLY binary little endian", "PCD compressed", "LAS 1.2 format 3", "text"
  std::uint64_t points = 0;  ///< as stored
  std::uint64_t finite_points = 0;  ///< kept
  std::vector<LeftOut> left_out;    ///< in the order in which the reasons came up
  std::string color_scale;          ///< what the color numbers mean: "0 to 255", "16 bit", ...; empty without color
  bool gray_colors = false;         ///< every color seen has equal channels
  std::string sha256;               ///< lowercase hex; empty unless asked for
  std::vector<std::string> notes;   ///< what was decided on the user's behalf: "8-bit colors in 16-bit fields", ...
  std::vector<Warning> warnings;    ///< what is probably wrong
  std::vector<Eigen::Vector3d> sensor_positions;  ///< where the scanner stood, world frame, meters; empty if unknown

  std::uint64_t n_left_out() const;
};

struct PointCloudFile {
  PointCloud cloud;
  FileInfo info;
};

/// What can be read, for people: "PLY, PCD, ... and KITTI .bin".
std::string readable_formats();

/// Reads a point cloud of any format that readable_formats() names (FORMATS, "Point clouds"), recognized by content
/// first, extension second. Points that are not finite are dropped and counted, and so are those that no sensor
/// measured (a coordinate of 1e9 or more; many points exactly at 0 0 0). What the color numbers mean is decided over
/// the whole file and said in `info`: 8- and 16-bit colors stay integers, others become floats in [0,1], a point
/// without one (NaN) keeps NaN; nothing but black is no color. The origin is choose_origin() of the bounds. Float files
/// near zero keep their floats exactly; a pipe is read into memory. Thread-safe. Throws InputError naming file, place
/// (line, byte, point or field) and reason: missing or unreadable file, unknown format, malformed or truncated content,
/// bytes left over, a number that no color has, no finite point.
PointCloudFile read_point_cloud(const std::filesystem::path& path, const ReadOptions& options = {});

/// Two files at once, each in a thread of its own. Throws what the first would throw, else the second.
std::pair<PointCloudFile, PointCloudFile> read_both(const std::filesystem::path& first,
                                                    const std::filesystem::path& second,
                                                    const ReadOptions& options = {});

/// A named value per point, written as a float property of its own.
struct PointField {
  std::string name;
  std::span<const float> values;
};

enum class PlyEncoding { kAscii, kBinaryLittleEndian };
enum class PcdEncoding { kAscii, kBinary, kBinaryCompressed };

/// Writes x y z (float where the origin is zero, else double, so that nothing is lost), the colors as stored, and the
/// fields. The file appears under its name only when complete. Throws OutputError if it cannot be written,
/// std::invalid_argument if a field's length is not the cloud's.
void write_ply(const std::filesystem::path& path, const PointCloud& cloud, std::span<const PointField> fields = {},
               PlyEncoding encoding = PlyEncoding::kBinaryLittleEndian);

/// The same into a file that the caller commits.
void write_ply(OutputFile& file, const PointCloud& cloud, std::span<const PointField> fields = {},
               PlyEncoding encoding = PlyEncoding::kBinaryLittleEndian);

/// The same as PCD v0.7; colors become packed 8-bit `rgb` (float32 bits), as PCL writes them.
void write_pcd(const std::filesystem::path& path, const PointCloud& cloud, PcdEncoding encoding = PcdEncoding::kBinary);

/// The same into a file that the caller commits.
void write_pcd(OutputFile& file, const PointCloud& cloud, PcdEncoding encoding = PcdEncoding::kBinary);

}  // namespace cmap
