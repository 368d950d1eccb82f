// Whether a file is a trajectory, for programs that take clouds too.

#include <system_error>

#include "clouds/not_a_cloud.hpp"
#include "cmap/io/number_text.hpp"
#include "cmap/io/trajectory_file.hpp"
#include "poses/trajectory_layout.hpp"
#include "poses/trajectory_rows.hpp"

namespace cmap {
namespace {

bool names_a_trajectory(const RowReader& reader, std::string_view names, std::size_t columns) {
  const auto layout = trajectory_layout_by_names(reader.lines(), names, columns);
  return layout && layout->time;
}

bool starts_with_number(const RowReader& reader) {
  double ignored = 0.0;
  return parse_number(reader.cells().front(), ignored);
}

/// By the names of columns, or the first rows.
bool starts_with_poses(ByteSource& source) {
  constexpr std::size_t kJudged = 64;
  RowReader reader(source);
  if (!reader.next()) return false;
  if (!starts_with_number(reader)) {
    const std::string header(reader.line());
    return reader.next() && names_a_trajectory(reader, header, reader.cells().size());
  }
  if (names_a_trajectory(reader, reader.comment(), reader.cells().size())) return true;
  std::vector<std::vector<double>> rows;
  do {
    std::vector<double>& row = rows.emplace_back();
    for (std::size_t i = 0; i < reader.cells().size(); ++i) row.push_back(reader.number(i));
  } while (rows.size() < kJudged && reader.next());
  return not_a_cloud(rows, false).has_value();
}

}  // namespace

bool holds_poses(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  try {
    ByteSource source(path);
    refuse_other_than_poses(source);
    return starts_with_poses(source);
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace cmap
