#include "captures/kitti_calibration.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "cmap/core/error.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/line_reader.hpp"
#include "cmap/io/number_text.hpp"
#include "poses/written_rotation.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

/// "R: 9.99e-01 ...": numbers by key; lines of other things, such as a time, are left out.
class CalibrationFile {
 public:
  CalibrationFile(const fs::path& drive, const char* name) : path_(drive / name) {
    const fs::path above = place_of_file(drive).parent_path() / name;
    if (!is_there(path_) && is_there(above)) path_ = above;
    ByteSource source(path_);
    LineReader lines(source);
    std::string_view line;
    while (lines.next(line)) {
      const std::size_t colon = line.find(':');
      if (colon == std::string_view::npos) continue;
      std::string_view rest = line.substr(colon + 1);
      std::vector<double> values;
      double value = 0.0;
      for (std::string_view token = next_token(rest); parse_number(token, value); token = next_token(rest)) {
        values.push_back(value);
      }
      values_[std::string(line.substr(0, colon))] = std::move(values);
    }
  }

  const std::vector<double>& get(const char* key, std::size_t n) const {
    const auto found = values_.find(key);
    if (found == values_.end()) throw InputError(fmt::format("{}: no line \"{}:\"", path_.string(), key));
    const bool is_finite = std::ranges::all_of(found->second, [](double value) { return std::isfinite(value); });
    if (found->second.size() == n && is_finite) return found->second;
    throw InputError(fmt::format("{}: {}: {} finite numbers expected", path_.string(), key, n));
  }

  Eigen::Matrix3d rotation(const char* key) const {
    const Eigen::Matrix3d matrix = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(get(key, 9).data());
    if (deviation_from_rotation(matrix) <= kRotationTolerance) return nearest_rotation(matrix);
    throw InputError(fmt::format("{}: {} is no rotation", path_.string(), key));
  }

  Eigen::Isometry3d transform() const {
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    transform.linear() = rotation("R");
    transform.translation() = Eigen::Vector3d(get("T", 3).data());
    return transform;
  }

  [[noreturn]] void fail(const std::string& reason) const { throw InputError(path_.string() + ": " + reason); }

 private:
  fs::path path_;
  std::map<std::string, std::vector<double>> values_;
};

/// The rectified camera 2 is camera 0's, turned by R_rect_00 and moved by the last column of P_rect_02.
void set_camera(const CalibrationFile& cameras, const Eigen::Isometry3d& T_camera0_lidar,
                CaptureCalibration& calibration) {
  const Eigen::Matrix<double, 3, 4> P =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(cameras.get("P_rect_02", 12).data());
  const std::vector<double>& size = cameras.get("S_rect_02", 2);
  CameraModel& camera = calibration.camera;
  camera.projection = CameraProjection::kPinhole;
  camera.width = static_cast<int>(std::clamp(size[0], 0.0, 1e6));
  camera.height = static_cast<int>(std::clamp(size[1], 0.0, 1e6));
  camera.fx = P(0, 0);
  camera.fy = P(1, 1);
  camera.cx = P(0, 2);
  camera.cy = P(1, 2);
  try {
    check(camera);
  } catch (const UsageError& error) {
    cameras.fail(fmt::format("P_rect_02, S_rect_02: {}", error.what()));
  }
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  T_camera_lidar.linear() = cameras.rotation("R_rect_00");
  T_camera_lidar = Eigen::Translation3d(P.leftCols<3>().inverse() * P.col(3)) * T_camera_lidar * T_camera0_lidar;
  calibration.T_lidar_camera = T_camera_lidar.inverse();
}

}  // namespace

CaptureCalibration read_kitti_calibration(const fs::path& drive) {
  CaptureCalibration calibration;
  calibration.T_imu_lidar = CalibrationFile(drive, "calib_imu_to_velo.txt").transform().inverse();
  set_camera(CalibrationFile(drive, "calib_cam_to_cam.txt"),
             CalibrationFile(drive, "calib_velo_to_cam.txt").transform(), calibration);
  return calibration;
}

}  // namespace cmap
