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

void set_camera(const CalibrationFile& cameras, const char* size_key, double fx, double fy, double cx, double cy,
                CameraModel& camera) {
  const std::vector<double>& size = cameras.get(size_key, 2);
  camera.projection = CameraProjection::kPinhole;
  camera.width = static_cast<int>(std::clamp(size[0], 0.0, 1e6));
  camera.height = static_cast<int>(std::clamp(size[1], 0.0, 1e6));
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
  try {
    check(camera);
  } catch (const UsageError& error) {
    cameras.fail(fmt::format("{}: {}", size_key, error.what()));
  }
}

/// The rectified camera 2 is camera 0, turned by R_rect_00 and moved by the last column of P_rect_02. T_camera_camera0.
Eigen::Isometry3d rectified_camera(const CalibrationFile& cameras, CameraModel& camera) {
  const Eigen::Matrix<double, 3, 4> P =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(cameras.get("P_rect_02", 12).data());
  set_camera(cameras, "S_rect_02", P(0, 0), P(1, 1), P(0, 2), P(1, 2), camera);
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.linear() = cameras.rotation("R_rect_00");
  return Eigen::Translation3d(P.leftCols<3>().inverse() * P.col(3)) * turned;
}

/// Camera 2 as it photographs.
Eigen::Isometry3d raw_camera(const CalibrationFile& cameras, CameraModel& camera) {
  const std::vector<double>& K = cameras.get("K_02", 9);
  set_camera(cameras, "S_02", K[0], K[4], K[2], K[5], camera);
  camera.distortion = cameras.get("D_02", 5);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = cameras.rotation("R_02");
  T.translation() = Eigen::Vector3d(cameras.get("T_02", 3).data());
  return T;
}

}  // namespace

CaptureCalibration read_kitti_calibration(const fs::path& drive) {
  CaptureCalibration calibration;
  calibration.T_imu_lidar = CalibrationFile(drive, "calib_imu_to_velo.txt").transform().inverse();
  const CalibrationFile cameras(drive, "calib_cam_to_cam.txt");
  const bool is_raw = place_of_file(drive).filename().string().ends_with("_extract");
  const Eigen::Isometry3d T_camera_camera0 =
      is_raw ? raw_camera(cameras, calibration.camera) : rectified_camera(cameras, calibration.camera);
  const Eigen::Isometry3d T_camera0_lidar = CalibrationFile(drive, "calib_velo_to_cam.txt").transform();
  calibration.T_lidar_camera = (T_camera_camera0 * T_camera0_lidar).inverse();
  return calibration;
}

}  // namespace cmap
