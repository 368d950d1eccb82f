#include "cmap/io/trajectory_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "poses/trajectory_order.hpp"
#include "poses/trajectory_rows.hpp"

namespace cmap {
namespace {

void tell_left_out(const TrajectoryRows& rows, const std::string& name, std::vector<Warning>& warnings) {
  const auto tell = [&](std::size_t n, const char* reason) {
    if (n == 0) return;
    warnings.push_back({"trajectory_rows_left_out",
                        fmt::format("{}: {} of {} rows left out: {} (lost tracking?)", name, n, rows.n_rows, reason)});
  };
  tell(rows.n_not_finite, "not finite");
  tell(rows.n_zero_rotation, "a quaternion of zero");
}

std::vector<double> read_times(const std::filesystem::path& path) {
  ByteSource source(path);
  refuse_other_than_poses(source);
  RowReader reader(source);
  std::vector<double> times;
  while (reader.next()) {
    if (reader.cells().size() != 1) {
      reader.lines().fail("{} numbers; one a line expected, the time of each pose", reader.cells().size());
    }
    times.push_back(reader.number(0));
  }
  return times;
}

/// Poses of which a row's index is known get that row's time; without a finite one they are left out.
void set_times(TrajectoryRows& rows, const std::string& name, const std::filesystem::path& path) {
  const std::vector<double> times = read_times(path);
  if (times.size() != rows.n_rows) {
    throw InputError(
        fmt::format("{}: {} times for the {} poses of {}", path.string(), times.size(), rows.n_rows, name));
  }
  const std::size_t n_before = rows.poses.size();
  std::erase_if(rows.poses, [&](StampedPose& pose) {
    pose.time_s = times[static_cast<std::size_t>(pose.time_s)];
    return !std::isfinite(pose.time_s);
  });
  rows.n_not_finite += n_before - rows.poses.size();
  rows.has_times = true;
}

TrajectoryFile finish(TrajectoryRows rows, const std::string& name) {
  TrajectoryFile file{{}, rows.has_times, rows.n_rows, {}, {}};
  if (rows.poses.empty()) {
    throw InputError(fmt::format("{}: none of its {} rows is a pose: {} not finite, {} with a quaternion of zero", name,
                                 rows.n_rows, rows.n_not_finite, rows.n_zero_rotation));
  }
  tell_left_out(rows, name, file.warnings);
  if (rows.decimal_comma) {
    file.warnings.push_back({"trajectory_decimal_comma", name + ": commas are read as decimal ones"});
  }
  file.poses = std::move(rows.poses);
  warn_of_zero_poses(file.poses, name, file.warnings);
  if (!file.has_times) return file;
  const double units_per_s = times_to_seconds(file.poses, rows.units_per_s, name, file.warnings);
  if (rows.assumed_order && units_per_s == 1e9) {
    file.warnings.push_back({"trajectory_quaternion_order",
                             name + ": no header line names the columns: the quaternion is read as x y z w, as in TUM "
                                    "files; EuRoC's have w first"});
  }
  file.repeated = put_in_order(file.poses, name, file.warnings);
  return file;
}

[[noreturn]] void refuse_without_times(const std::filesystem::path& path, const TrajectoryRows& rows) {
  throw InputError(fmt::format("{}: {} poses without times (KITTI's layout); --times FILE gives them, one a line",
                               path.string(), rows.n_rows));
}

TrajectoryRows read_rows_of(const std::filesystem::path& path) {
  ByteSource source(path);
  return read_trajectory_rows(source);
}

}  // namespace

Trajectory with_repeated(const TrajectoryFile& file) {
  Trajectory all;
  std::merge(file.poses.begin(), file.poses.end(), file.repeated.begin(), file.repeated.end(), std::back_inserter(all),
             [](const StampedPose& a, const StampedPose& b) { return a.time_s < b.time_s; });
  return all;
}

TrajectoryFile parse_trajectory(ByteSource& source) { return finish(read_trajectory_rows(source), source.name()); }

TrajectoryFile read_trajectory(const std::filesystem::path& path) {
  ByteSource source(path);
  return parse_trajectory(source);
}

std::pair<TrajectoryFile, TrajectoryFile> read_trajectory_pair(const std::filesystem::path& first,
                                                               const std::filesystem::path& second,
                                                               const std::optional<std::filesystem::path>& times) {
  TrajectoryRows first_rows = read_rows_of(first), second_rows = read_rows_of(second);
  const bool paired_by_row = !times && !first_rows.has_times && !second_rows.has_times;
  if (times && first_rows.has_times && second_rows.has_times) {
    throw UsageError(fmt::format("{}: not needed, both trajectories hold their times", times->string()));
  }
  for (const auto& [path, rows] : {std::pair(&first, &first_rows), std::pair(&second, &second_rows)}) {
    if (rows->has_times) continue;
    if (times) set_times(*rows, path->string(), *times);
    if (!times && (!paired_by_row || first_rows.n_rows != second_rows.n_rows)) refuse_without_times(*path, *rows);
  }
  std::pair<TrajectoryFile, TrajectoryFile> pair{finish(std::move(first_rows), first.string()),
                                                 finish(std::move(second_rows), second.string())};
  if (paired_by_row) {
    pair.first.warnings.push_back(
        {"trajectory_paired_by_row", fmt::format("{} and {} hold no times: their {} poses are paired row by row",
                                                 first.string(), second.string(), pair.first.rows)});
  }
  return pair;
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
