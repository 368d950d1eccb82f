#include "captures/capture_json.hpp"

#include <fmt/format.h>

#include "bytes/input_json.hpp"
#include "captures/picture_fit.hpp"
#include "cmap/core/error.hpp"
#include "poses/written_rotation.hpp"

namespace cmap {
namespace {

using Json = nlohmann::ordered_json;

Eigen::Matrix4d matrix_of(const Json& json, const char* name) {
  const auto refuse = [&] { throw UsageError(fmt::format("{}: a 4x4 matrix of numbers expected", name)); };
  if (!json.is_array() || json.size() != 4) refuse();
  Eigen::Matrix4d matrix;
  for (std::size_t row = 0; row < 4; ++row) {
    if (!json[row].is_array() || json[row].size() != 4) refuse();
    for (std::size_t column = 0; column < 4; ++column) {
      matrix(static_cast<int>(row), static_cast<int>(column)) = finite_number(json[row][column], name);
    }
  }
  return matrix;
}

/// The rotation and translation that a matrix of the calibration means.
Eigen::Isometry3d transform_of(const Json& json, const char* name, CaptureDescription& description) {
  constexpr double kNoRotation = 0.2;  // typing errors in published calibrations reach 0.05
  const Eigen::Matrix4d matrix = matrix_of(json, name);
  if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw UsageError(fmt::format("{}: the last row is not 0 0 0 1 (is the matrix column-major?)", name));
  }
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double deviation = deviation_from_rotation(rotation);
  if (!(deviation <= kNoRotation)) {
    throw UsageError(fmt::format("{}: no rotation: |R^T R - I| = {:g}, det R = {:g}", name,
                                 (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
                                 rotation.determinant()));
  }
  if (deviation > kRotationTolerance) {
    description.warnings.push_back(
        {"rotation_not_orthonormal",
         fmt::format("capture.json: {} deviates from a rotation by {:.2g}; the nearest one is used. Is a digit wrong?",
                     name, deviation)});
  }
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  // What is a rotation to the last bits stays as it was written.
  constexpr double kRounding = 1e-12;
  transform.linear() = deviation <= kRounding ? rotation : nearest_rotation(rotation);
  transform.translation() = matrix.topRightCorner<3, 1>();
  return transform;
}

CameraModel camera_of(const Json& json) {
  check_keys(json, "camera", {"model", "width", "height", "K"}, {"distortion"});
  CameraModel camera;
  if (json["model"] != "pinhole" && json["model"] != "fisheye") {
    throw UsageError(fmt::format("camera.model is {}; \"pinhole\" or \"fisheye\" expected", json["model"].dump()));
  }
  camera.projection = json["model"] == "pinhole" ? CameraProjection::kPinhole : CameraProjection::kFisheye;
  camera.width = whole_number(json["width"], "camera.width");
  camera.height = whole_number(json["height"], "camera.height");
  const Json& K = json["K"];
  if (!K.is_array() || K.size() != 4) throw UsageError("camera.K: [fx, fy, cx, cy] expected");
  double* const places[] = {&camera.fx, &camera.fy, &camera.cx, &camera.cy};
  for (std::size_t i = 0; i < 4; ++i) *places[i] = finite_number(K[i], "camera.K");
  if (json.contains("distortion")) {
    if (!json["distortion"].is_array()) throw UsageError("camera.distortion: an array of numbers expected");
    for (const Json& k : json["distortion"]) camera.distortion.push_back(finite_number(k, "camera.distortion"));
  }
  check(camera);
  return camera;
}

double acceleration_unit_of(const Json& json) {
  check_keys(json, "imu", {"acceleration_unit"});
  const Json& unit = json["acceleration_unit"];
  if (unit == "m/s^2") return 1.0;
  if (unit == "g") return kStandardGravity_mps2;
  throw UsageError(fmt::format("imu.acceleration_unit is {}; \"m/s^2\" or \"g\" expected", unit.dump()));
}

void read_offsets(const Json& json, CaptureCalibration& calibration) {
  check_keys(json, "time_offset", {}, {"image_s", "imu_s"});
  if (json.contains("image_s")) calibration.image_time_offset_s = finite_number(json["image_s"], "time_offset.image_s");
  if (json.contains("imu_s")) calibration.imu_time_offset_s = finite_number(json["imu_s"], "time_offset.imu_s");
}

Json matrix_json(const Eigen::Isometry3d& transform) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) {
    Json values = Json::array();
    for (int column = 0; column < 4; ++column) values.push_back(transform.matrix()(row, column));
    rows.push_back(std::move(values));
  }
  return rows;
}

}  // namespace

CaptureDescription parse_capture_json(const std::string& text, const std::string& source, const Faults& faults,
                                      bool needs_camera) {
  CaptureDescription description;
  CaptureCalibration& calibration = description.calibration;
  Json parsed;
  const bool is_json = faults.attempt([&] { read_input_json(text, source, [&](const Json& json) { parsed = json; }); });
  if (!is_json) return description;
  const auto part = [&](const JsonReader& read) {
    faults.attempt([&] { read_parsed_input_json(parsed, source, read); });
  };
  // A part that is not there is named with all keys.
  const auto part_of = [&](const char* key, const JsonReader& read) {
    part([&](const Json& json) {
      if (json.contains(key)) read(json[key]);
    });
  };
  part([&](const Json& json) {
    if (needs_camera) {
      check_keys(json, "", {"version", "camera", "T_imu_lidar", "T_lidar_camera"},
                 {"imu", "time_offset", "T_world_imu_start"});
    } else {
      check_keys(json, "", {"version", "T_imu_lidar"},
                 {"camera", "T_lidar_camera", "imu", "time_offset", "T_world_imu_start"});
    }
  });
  if (!parsed.is_object()) return description;
  part_of("version", [](const Json& json) {
    if (json != 1) throw UsageError(fmt::format("version is {}; 1 expected", json.dump()));
  });
  part_of("camera", [&](const Json& json) {
    const CameraModel& camera = calibration.camera = camera_of(json);
    const std::string doubt = principal_point_doubt(camera.cx, camera.cy, camera.width, camera.height);
    if (!doubt.empty()) description.warnings.push_back({"camera_of_another_size", source + ": camera.K: " + doubt});
  });
  for (auto [key, T] :
       {std::pair("T_imu_lidar", &calibration.T_imu_lidar), std::pair("T_lidar_camera", &calibration.T_lidar_camera)}) {
    part_of(key, [&](const Json& json) { *T = transform_of(json, key, description); });
  }
  part_of("T_world_imu_start", [&](const Json& json) {
    calibration.T_world_imu_start = transform_of(json, "T_world_imu_start", description);
  });
  part_of("imu", [&](const Json& json) { description.acceleration_unit_mps2 = acceleration_unit_of(json); });
  part_of("time_offset", [&](const Json& json) { read_offsets(json, calibration); });
  return description;
}

std::string capture_json(const CaptureCalibration& calibration) {
  const CameraModel& camera = calibration.camera;
  Json json = {
      {"version", 1},
      {"camera",
       {{"model", camera.projection == CameraProjection::kPinhole ? "pinhole" : "fisheye"},
        {"width", camera.width},
        {"height", camera.height},
        {"K", {camera.fx, camera.fy, camera.cx, camera.cy}},
        {"distortion", camera.distortion}}},
      {"T_imu_lidar", matrix_json(calibration.T_imu_lidar)},
      {"T_lidar_camera", matrix_json(calibration.T_lidar_camera)},
      {"imu", {{"acceleration_unit", "m/s^2"}}},
      {"time_offset", {{"image_s", calibration.image_time_offset_s}, {"imu_s", calibration.imu_time_offset_s}}}};
  if (calibration.T_world_imu_start) json["T_world_imu_start"] = matrix_json(*calibration.T_world_imu_start);
  return json.dump(1) + "\n";
}

}  // namespace cmap
