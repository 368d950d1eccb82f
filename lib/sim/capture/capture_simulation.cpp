#include "cmap/sim/capture_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "capture/capture_descriptions.hpp"
#include "capture/capture_preview.hpp"
#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/core/parallel.hpp"
#include "cmap/geometry/rotation.hpp"
#include "cmap/io/capture.hpp"
#include "cmap/io/image_file.hpp"
#include "cmap/io/output_file.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "cmap/sim/network_input.hpp"
#include "cmap/sim/random_stream.hpp"
#include "cmap/sim/seen_surface.hpp"
#include "sensors/lio_drift.hpp"

namespace cmap {
namespace {

namespace fs = std::filesystem;

void check_capture_options(CaptureOptions options) {
  for_each_section(options, [](const char* name, auto& section) { check_fields(section, name); });
  check(camera_of(options.camera));
  network_camera(camera_of(options.camera), options.predictions.width_px);
  cut_sessions(1, options.predictions.session_length, options.predictions.session_overlap);
}

/// What capture.json says, with the errors asked for.
CaptureCalibration stated_calibration(const CaptureOptions& o, const PoseSpline& path) {
  CaptureCalibration calibration;
  calibration.camera = camera_of(o.camera);
  calibration.T_imu_lidar = T_imu_lidar_of(o.mount);
  calibration.T_lidar_camera = T_lidar_camera_of(o.mount);
  calibration.T_lidar_camera.translation() += o.stated.camera_translation_error_m;
  const Eigen::Vector3d turn = o.stated.camera_rotation_error_deg * (std::numbers::pi / 180.0);
  calibration.T_lidar_camera.linear() = calibration.T_lidar_camera.linear() * rotation_from(turn);
  calibration.T_world_imu_start = path.pose(path.start_s());
  return calibration;
}

/// First, first + 1 / rate, ... up to and including `last_s`.
std::vector<double> times_between(double first_s, double last_s, double rate_hz) {
  std::vector<double> times;
  for (std::size_t i = 0;; ++i) {
    const double t = first_s + static_cast<double>(i) / rate_hz;
    if (t > last_s + 1e-9) return times;
    times.push_back(t);
  }
}

void write_text(const fs::path& path, const std::string& text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

/// One capture while it is being made, a step per member function.
class CaptureRun {
 public:
  CaptureRun(const CaptureOptions& options, const fs::path& folder)
      : o_(options),
        seed_(static_cast<std::uint64_t>(options.seed)),
        scene_(make_scene(options.scene)),
        path_(make_path(make_route(scene_, options.route), options.path, seed_)),
        writer_(folder, stated_calibration(options, path_)),
        truth_(writer_.subfolder("truth")),
        T_imu_lidar_(T_imu_lidar_of(options.mount)),
        T_imu_camera_(T_imu_lidar_ * T_lidar_camera_of(options.mount)) {
    end_s_ = path_.end_s();
    if (o_.max_duration_s > 0.0) end_s_ = std::min(end_s_, path_.start_s() + o_.max_duration_s);
    image_times_ = times_between(path_.start_s() + o_.camera.begin_s + o_.camera.phase_s, end_s_, o_.camera.rate_hz);
    if (image_times_.empty()) throw UsageError("camera: begin_s: the path ends before the first picture");
  }

  void make() {
    report_progress("imu", 0.02);
    write_motion();
    write_scans();
    write_images();
    report_progress("map", 0.9);
    write_map();
    write_text(truth_ / "options.json", to_json(o_).dump(1) + "\n");
    write_preview();
    writer_.commit();
  }

 private:
  /// Calls work(i) for every i, reporting from `from` to `to`.
  template <class Work>
  void for_each(std::string_view stage, std::size_t n, double from, double to, Work&& work) const {
    for (std::size_t i = 0; i < n; ++i) {
      report_progress(stage, from + (to - from) * static_cast<double>(i) / static_cast<double>(n));
      work(i);
    }
  }

  Eigen::Isometry3d T_world_camera(double time_s) const { return path_.pose(time_s) * T_imu_camera_; }

  void write_motion() {
    std::vector<ImuSample> imu = simulate_imu(path_, o_.imu, seed_);
    std::erase_if(imu, [&](const ImuSample& sample) { return sample.time_s > end_s_ + 1e-9; });
    writer_.write_imu(imu);
    write_tum_trajectory(true_trajectory(path_, times_between(path_.start_s(), end_s_, o_.truth.trajectory_rate_hz)),
                         truth_ / "trajectory.tum");
    if (!o_.stated.lio) return;
    const std::vector<double> ends = times_between(path_.start_s(), end_s_, o_.lidar.scan_rate_hz);
    writer_.write_lio(with_lio_drift(true_trajectory(path_, ends), o_.stated, seed_));
  }

  void write_scans() {
    const double last_s = end_s_ - 1.0 / o_.lidar.scan_rate_hz;
    const std::vector<double> starts = times_between(path_.start_s(), last_s, o_.lidar.scan_rate_hz);
    for_each("scans", starts.size(), 0.05, 0.3, [&](std::size_t i) {
      LidarScan scan = simulate_scan(scene_, path_, T_imu_lidar_, o_.lidar, starts[i], seed_);
      writer_.add_scan(scan);
      if (i == starts.size() / 2) middle_scan_ = std::move(scan);
    });
  }

  /// Exposure of a picture: the network gets the same.
  double gain(std::size_t image) const {
    return std::exp(o_.camera.exposure_noise * RandomStream(seed_, kRandomExposure, image).normal());
  }

  void add_pixel_noise(RgbImage& image, std::size_t number) const {
    if (!(o_.camera.pixel_noise_u8 > 0.0)) return;
    const std::uint64_t own_seed = RandomStream(seed_, kRandomImagePixel, number).bits();
    parallel_chunks(image.pixels.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        RandomStream random(own_seed, kRandomImagePixel, i);
        for (std::uint8_t& channel : image.pixels[i]) {
          const double level = channel + o_.camera.pixel_noise_u8 * random.normal();
          channel = static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, 255.0)));
        }
      }
    });
  }

  RgbImage take_image(std::size_t i, const CameraModel& camera) {
    RgbImage image = render_image(scene_, camera, T_world_camera(image_times_[i]),
                                  {o_.camera.supersampling, gain(i), o_.camera.vignetting});
    add_pixel_noise(image, i);
    const fs::path file =
        writer_.add_image(stated_time(i), fmt::format(".{}", name_of(o_.camera.format, kPictureFormatNames)));
    write_image(image, file);
    image_names_.push_back(file.filename().string());
    return image;
  }

  double stated_time(std::size_t image) const { return image_times_[image] + o_.stated.image_time_error_s; }

  NetworkFrame network_frame(std::size_t i, const RgbImage& image, const CameraModel& camera,
                             const CameraModel& network) const {
    NetworkFrame frame;
    frame.frame = {0, stated_time(i), image_names_[i], camera.width, camera.height};
    frame.T_world_camera = T_world_camera(image_times_[i]);
    NetworkImage seen = network_image(image, camera, network);
    frame.view = {std::move(seen.image), render_depth(scene_, network, frame.T_world_camera)};
    for (std::size_t pixel = 0; pixel < seen.is_shown.size(); ++pixel) {
      if (seen.is_shown[pixel] == 0) frame.view.depth_m[pixel] = std::numeric_limits<float>::infinity();
    }
    return frame;
  }

  /// Pictures, and what the network makes of them: a session as soon as its last picture is there.
  void write_images() {
    const CameraModel camera = camera_of(o_.camera), network = network_camera(camera, o_.predictions.width_px);
    const auto stride = static_cast<std::size_t>(o_.predictions.image_stride);
    const auto sessions = cut_sessions((image_times_.size() + stride - 1) / stride, o_.predictions.session_length,
                                       o_.predictions.session_overlap);
    std::size_t next = 0;             // session
    std::deque<NetworkFrame> frames;  // from the next session's first one on
    for_each("images", image_times_.size(), 0.3, 0.9, [&](std::size_t i) {
      RgbImage image = take_image(i, camera);
      if (i % stride == 0) frames.push_back(network_frame(i, image, camera, network));
      if (i == image_times_.size() / 2) {
        middle_view_ = {std::move(image), render_depth(scene_, camera, T_world_camera(image_times_[i]))};
      }
      if (next == sessions.size() || frames.size() < sessions[next].count) return;
      write_session(next, frames, network);
      if (++next == sessions.size()) return;
      const std::size_t passed = sessions[next].first - sessions[next - 1].first;
      frames.erase(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(passed));
    });
    write_text(truth_ / "scales.json", scales_.dump(1) + "\n");
  }

  void write_session(std::size_t number, const std::deque<NetworkFrame>& frames, const CameraModel& network) {
    std::vector<const NetworkFrame*> pointers;
    for (const NetworkFrame& frame : frames) pointers.push_back(&frame);
    const SimulatedSession session = simulate_session(pointers, network, number, o_.predictions, seed_);
    writer_.add_session(session.predictions);
    const std::string name = fmt::format("session_{:04}", number);
    scales_["scales"][name] = session.unit_m;
    if (session.pose_stretch != 1.0) scales_["pose_stretch"][name] = session.pose_stretch;
  }

  void write_map() const {
    std::vector<Eigen::Isometry3d> cameras;
    for (const double t : image_times_) cameras.push_back(T_world_camera(t));
    write_ply(truth_ / "map.ply", seen_surface(scene_, camera_of(o_.camera), cameras,
                                               {o_.truth.map_points_per_m2, o_.truth.map_max_distance_m, seed_}));
  }

  void write_preview() const {
    // Under the ceiling of a room, over the roofs of a town.
    const double z = o_.scene.kind == SceneKind::kIndoor ? path_.pose(path_.start_s()).translation().z() + 0.5
                                                         : scene_.bounds().max.z() + 1.0;
    const Eigen::Matrix3f R_world_lidar = (path_.pose(middle_scan_.timestamp_s) * T_imu_lidar_).linear().cast<float>();
    std::vector<Eigen::Vector3f> scan;
    for (const Eigen::Vector3f& p : middle_scan_.positions) scan.emplace_back(R_world_lidar * p);
    write_image(capture_preview(scene_, path_, z, middle_view_, scan), truth_ / "preview.png");
  }

  const CaptureOptions& o_;
  std::uint64_t seed_;
  Scene scene_;
  PoseSpline path_;
  CaptureWriter writer_;
  fs::path truth_;
  Eigen::Isometry3d T_imu_lidar_, T_imu_camera_;
  double end_s_ = 0.0;
  std::vector<double> image_times_;
  std::vector<std::string> image_names_;
  LidarScan middle_scan_;  ///< for the preview
  CameraView middle_view_;
  nlohmann::ordered_json scales_{{"version", 1}, {"unit", "metres per session unit"}};
};

}  // namespace

void simulate_capture(const CaptureOptions& options, const fs::path& folder, const Execution& execution) {
  const ExecutionScope scope(execution);
  check_capture_options(options);
  report_progress("scene", 0.0);
  CaptureRun(options, folder).make();
}

}  // namespace cmap
