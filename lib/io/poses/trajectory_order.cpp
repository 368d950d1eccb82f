#include "poses/trajectory_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "cmap/geometry/order_statistics.hpp"

namespace cmap {
namespace {

struct Unit {
  double units_per_s;
  std::string_view name;
};

/// Of times of the last and the next decades, counted from 1970.
Unit unit_of(double time) {
  if (time < 1e11) return {1.0, "seconds"};
  if (time < 1e14) return {1e3, "milliseconds"};
  if (time < 1e17) return {1e6, "microseconds"};
  return {1e9, "nanoseconds"};
}

bool same_pose(const StampedPose& a, const StampedPose& b) {
  return a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs();
}

double median_step_s(const Trajectory& poses) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < poses.size(); ++i) steps_s.push_back(std::abs(poses[i].time_s - poses[i - 1].time_s));
  return upper_median(steps_s);
}

const char* plural(std::size_t n, const char* one, const char* several) { return n == 1 ? one : several; }

}  // namespace

double times_to_seconds(Trajectory& poses, double units_per_s, const std::string& name,
                        std::vector<Warning>& warnings) {
  constexpr double kDay_s = 86400.0;
  if (units_per_s == 0.0) {
    double largest = 0.0;
    for (const StampedPose& pose : poses) largest = std::max(largest, std::abs(pose.time_s));
    const Unit unit = unit_of(largest);
    units_per_s = unit.units_per_s;
    if (units_per_s != 1.0) {
      warnings.push_back({"trajectory_time_unit", fmt::format("{}: its times are read as {}", name, unit.name)});
    }
  }
  for (StampedPose& pose : poses) pose.time_s /= units_per_s;
  if (poses.size() > 1 && units_per_s == 1.0 && median_step_s(poses) > kDay_s) {
    warnings.push_back(
        {"trajectory_time_unit", fmt::format("{}: its poses are {:g} s apart, which is more than a day: are its times "
                                             "nanoseconds? They are read as seconds",
                                             name, median_step_s(poses))});
  }
  return units_per_s;
}

void warn_of_zero_poses(const Trajectory& poses, const std::string& name, std::vector<Warning>& warnings) {
  constexpr double kNoRotation = 1.0 - 1e-12;
  const auto is_zero = [](const StampedPose& pose) {
    return pose.position == Eigen::Vector3d::Zero() && std::abs(pose.rotation.w()) >= kNoRotation;
  };
  const auto n = std::count_if(std::find_if_not(poses.begin(), poses.end(), is_zero), poses.end(), is_zero);
  if (n < 2) return;
  warnings.push_back(
      {"trajectory_zero_poses",
       fmt::format("{}: {} of {} poses are exactly 0 0 0 without rotation, after others that are not: lost "
                   "tracking? They count as poses",
                   name, n, poses.size())});
}

Trajectory put_in_order(Trajectory& poses, const std::string& name, std::vector<Warning>& warnings) {
  const auto earlier = [](const StampedPose& a, const StampedPose& b) { return a.time_s < b.time_s; };
  std::size_t n_late = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) n_late += earlier(poses[i], poses[i - 1]);
  if (n_late > 0) {
    std::stable_sort(poses.begin(), poses.end(), earlier);
    warnings.push_back(
        {"trajectory_unordered", fmt::format("{}: {} {} before the row above in time; the poses are sorted by time",
                                             name, n_late, plural(n_late, "row is", "rows are"))});
  }
  std::size_t n_repeated = 0, n_other = 0, n_kept = 0;
  Trajectory left_out;
  for (const StampedPose& pose : poses) {
    if (n_kept > 0 && pose.time_s == poses[n_kept - 1].time_s) {
      ++(same_pose(pose, poses[n_kept - 1]) ? n_repeated : n_other);
      left_out.push_back(pose);
    } else {
      poses[n_kept++] = pose;
    }
  }
  poses.resize(n_kept);
  if (n_repeated > 0) {
    warnings.push_back(
        {"trajectory_repeated", fmt::format("{}: {} left out", name,
                                            n_repeated == 1 ? std::string("a repeated pose is")
                                                            : fmt::format("{} repeated poses are", n_repeated))});
  }
  if (n_other > 0) {
    warnings.push_back(
        {"trajectory_same_time",
         fmt::format("{}: {} the time of an earlier row but another pose, and {} left out: the first is kept", name,
                     n_other == 1 ? std::string("a row has") : fmt::format("{} rows have", n_other),
                     plural(n_other, "is", "are"))});
  }
  return left_out;
}

}  // namespace cmap
