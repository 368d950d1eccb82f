#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cmap/align/trajectory.hpp"

namespace cmap {

/// What an alignment of trajectories has beside alignment_json(): `ate`, for each pairing its name, n_pairs and rmse_m;
/// misfit_times_s; time_offset_s, and found_time_offset or null.
nlohmann::ordered_json trajectory_json(const TrajectoryAlignment& found);

/// The same for people, without the poses that do not fit, which a warning names.
std::string trajectory_lines(const TrajectoryAlignment& found);

}  // namespace cmap
