#include "cmap/io/trajectory_file.hpp"

#include <array>
#include <cmath>

#include "io/line_reader.hpp"
#include "io/number_text.hpp"
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

/// False on a line without numbers.
bool parse_line(const LineReader& lines, std::string_view line, std::array<double, 8>& values) {
  line = line.substr(0, line.find('#'));
  std::size_t n = 0;
  for (std::string_view token; next_column(line, token); ++n) {
    double value = 0.0;
    if (!parse_number(token, value)) lines.fail("'{}' is not a number", token.substr(0, 40));
    if (!std::isfinite(value)) lines.fail("'{}' is not finite", token.substr(0, 40));
    if (n == values.size()) lines.fail("more than the 8 numbers of a pose: time x y z qx qy qz qw");
    values[n] = value;
  }
  if (n != 0 && n != values.size()) lines.fail("{} numbers; a pose has 8: time x y z qx qy qz qw", n);
  return n != 0;
}

}  // namespace

Trajectory read_tum_trajectory(const std::filesystem::path& path) {
  ByteSource source(path);
  LineReader lines(source);
  Trajectory trajectory;
  std::string_view line;
  std::array<double, 8> values{};
  while (lines.next(line)) {
    if (!parse_line(lines, line, values)) continue;
    const StampedPose pose = pose_of(lines, values);
    if (!trajectory.empty() && !(pose.time_s > trajectory.back().time_s)) {
      lines.fail("time {} s is not after the {} s before it", pose.time_s, trajectory.back().time_s);
    }
    trajectory.push_back(pose);
  }
  if (trajectory.empty()) source.fail("no pose in the file");
  return trajectory;
}

}  // namespace cmap
