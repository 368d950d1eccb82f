#include "cmap/io/trajectory_file.hpp"

#include <array>
#include <cmath>

#include "cmap/io/output_file.hpp"
#include "io/line_reader.hpp"
#include "io/number_text.hpp"
#include "io/rotation_check.hpp"
#include "io/text_layout.hpp"

namespace cmap {
namespace {

/// Shorter ones have no direction that their digits could give.
constexpr double kShortestQuaternion = 1e-6;

StampedPose pose_of(const LineReader& lines, const std::array<double, 8>& v) {
  StampedPose pose{v[0], {v[1], v[2], v[3]}, Eigen::Quaterniond(v[7], v[4], v[5], v[6])};
  const double length = pose.rotation.norm();
  if (!(length > kShortestQuaternion)) lines.fail("the quaternion has length {:g}", length);
  pose.rotation.coeffs() /= length;
  return pose;
}

/// What a line holds, for messages.
struct LineKind {
  std::string_view name, order;
};

/// False on a line without numbers.
template <std::size_t n_values>
bool parse_line(const LineReader& lines, std::string_view line, const LineKind& kind,
                std::array<double, n_values>& values) {
  line = line.substr(0, line.find('#'));
  std::size_t n = 0;
  for (std::string_view token; next_column(line, token); ++n) {
    double value = 0.0;
    if (!parse_number(token, value)) lines.fail("'{}' is not a number", token.substr(0, 40));
    if (!std::isfinite(value)) lines.fail("'{}' is not finite", token.substr(0, 40));
    if (n == n_values) lines.fail("more than the {} numbers of {}: {}", n_values, kind.name, kind.order);
    values[n] = value;
  }
  if (n != 0 && n != n_values) lines.fail("{} numbers; {} has {}: {}", n, kind.name, n_values, kind.order);
  return n != 0;
}

void require_later(const LineReader& lines, double time_s, double last_s) {
  if (!(time_s > last_s)) lines.fail("time {} s is not after the {} s before it", time_s, last_s);
}

std::vector<double> read_times(const std::filesystem::path& path) {
  ByteSource source(path);
  LineReader lines(source);
  std::vector<double> times_s;
  std::string_view line;
  std::array<double, 1> time_s{};
  while (lines.next(line)) {
    if (!parse_line(lines, line, {"a line", "seconds"}, time_s)) continue;
    if (!times_s.empty()) require_later(lines, time_s[0], times_s.back());
    times_s.push_back(time_s[0]);
  }
  return times_s;
}

StampedPose pose_of_matrix(const LineReader& lines, const double* rows) {
  const Eigen::Matrix<double, 3, 4> matrix = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(rows);
  const double deviation = deviation_from_rotation(matrix.leftCols<3>());
  if (!(deviation <= kRotationTolerance)) {
    lines.fail("the matrix deviates by {:g} from a rotation; {:g} accepted", deviation, kRotationTolerance);
  }
  return {0.0, matrix.col(3), Eigen::Quaterniond(nearest_rotation(matrix.leftCols<3>()))};
}

/// Poses as matrices of 3 or 4 rows; their times are still missing.
template <std::size_t n_values>
Trajectory read_matrices(const std::filesystem::path& path) {
  ByteSource source(path);
  LineReader lines(source);
  Trajectory trajectory;
  std::string_view line;
  std::array<double, n_values> values{};
  while (lines.next(line)) {
    if (!parse_line(lines, line, {"a pose", "the rows of its matrix"}, values)) continue;
    if constexpr (n_values == 16) {
      const Eigen::Map<const Eigen::RowVector4d> last(values.data() + 12);
      if (last != Eigen::RowVector4d(0, 0, 0, 1)) lines.fail("the last row of the matrix is not 0 0 0 1");
    }
    trajectory.push_back(pose_of_matrix(lines, values.data()));
  }
  if (trajectory.empty()) source.fail("no pose in the file");
  return trajectory;
}

void set_times(Trajectory& trajectory, const std::filesystem::path& path) {
  const std::vector<double> times_s = read_times(path);
  if (times_s.size() != trajectory.size()) {
    throw InputError(fmt::format("{}: {} times for {} poses", path.string(), times_s.size(), trajectory.size()));
  }
  for (std::size_t i = 0; i < times_s.size(); ++i) trajectory[i].time_s = times_s[i];
}

}  // namespace

Trajectory read_tum_trajectory(const std::filesystem::path& path) {
  ByteSource source(path);
  LineReader lines(source);
  Trajectory trajectory;
  std::string_view line;
  std::array<double, 8> values{};
  while (lines.next(line)) {
    if (!parse_line(lines, line, {"a pose", "time x y z qx qy qz qw"}, values)) continue;
    const StampedPose pose = pose_of(lines, values);
    if (!trajectory.empty()) require_later(lines, pose.time_s, trajectory.back().time_s);
    trajectory.push_back(pose);
  }
  if (trajectory.empty()) source.fail("no pose in the file");
  return trajectory;
}

Trajectory read_kitti_trajectory(const std::filesystem::path& poses, const std::filesystem::path& times) {
  Trajectory trajectory = read_matrices<12>(poses);
  set_times(trajectory, times);
  return trajectory;
}

Trajectory read_camera_poses(const std::filesystem::path& poses, const std::optional<std::filesystem::path>& times) {
  Trajectory trajectory = read_matrices<16>(poses);
  if (times) {
    set_times(trajectory, *times);
  } else {
    for (std::size_t i = 0; i < trajectory.size(); ++i) trajectory[i].time_s = static_cast<double>(i);
  }
  return trajectory;
}

void write_tum_trajectory(const Trajectory& trajectory, const std::filesystem::path& path) {
  OutputFile file(path);
  write_tum_trajectory(trajectory, file);
  file.commit();
}

void write_tum_trajectory(const Trajectory& trajectory, OutputFile& file) {
  file.write("# timestamp_s tx ty tz qx qy qz qw\n");
  for (const StampedPose& pose : trajectory) {
    const auto& p = pose.position;
    const auto& q = pose.rotation;
    file.write(fmt::format("{} {} {} {} {} {} {} {}\n", pose.time_s, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()));
  }
}

}  // namespace cmap
