#include "cmap/io/session_file.hpp"

#include "bytes/csv_table.hpp"
#include "bytes/input_json.hpp"
#include "captures/session_arrays.hpp"
#include "captures/session_files.hpp"
#include "cmap/io/file_place.hpp"
#include "cmap/io/number_text.hpp"

namespace cmap {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

int original_size(const CsvTable& table, std::size_t column) {
  constexpr std::uint64_t kMost = 1 << 20;
  const std::uint64_t size = table.whole_number(column);
  if (size == 0 || size > kMost) table.lines().fail("an image side of {} pixels", size);
  return static_cast<int>(size);
}

/// As many as there are in the arrays, where that is known; none where a row is faulty.
std::vector<PredictionFrame> read_frames(const fs::path& path, std::size_t frame_count, const Faults& faults) {
  if (!is_there(path)) {
    throw InputError(path.string() + ": no such file; the times of the session's frames expected there");
  }
  ByteSource source(path);
  CsvTable table(source, {"index", "timestamp_s", "image_name", "orig_w", "orig_h"});
  IncreasingTimes times;
  std::vector<PredictionFrame> frames;
  const bool is_good = table.for_each_row(faults, [&] {
    const std::size_t index = frames.size();
    PredictionFrame& frame = frames.emplace_back();
    frame.index = index;
    if (table.whole_number(0) != index) table.lines().fail("index {}; {} expected", table.cell(0), index);
    frame.time_s = table.number(1);
    times.add(table.lines(), frame.time_s);
    frame.image_name = table.cell(2);
    frame.original_width = original_size(table, 3);
    frame.original_height = original_size(table, 4);
  });
  if (frame_count > 0 && frames.size() != frame_count) {
    source.fail("{} frames, but {} in the arrays", frames.size(), frame_count);
  }
  if (!is_good) frames.clear();
  return frames;
}

void require_same_size(const Json& meta, const char* key, std::size_t expected) {
  if (!meta.contains(key)) throw UsageError(fmt::format("key \"{}\" is missing", key));
  if (static_cast<std::size_t>(whole_number(meta[key], key)) != expected) {
    throw UsageError(fmt::format("{} is {}, but that of the depth is {}", key, meta[key].dump(), expected));
  }
}

void require_convention(const Json& meta, const char* key, std::initializer_list<std::string_view> known) {
  if (!meta.contains(key)) throw UsageError(fmt::format("key \"{}\" is missing", key));
  for (const std::string_view value : known) {
    if (meta[key] == value) return;
  }
  throw UsageError(fmt::format("{} is {}; \"{}\" expected", key, meta[key].dump(), *known.begin()));
}

/// Other keys say where a session comes from, and are not read.
void check_meta(const fs::path& path, const SessionPredictions& session, std::size_t frame_count,
                const Faults& faults) {
  Json parsed;
  const bool is_json = faults.attempt(
      [&] { read_input_json_file(path, "the description of a session", [&](const Json& meta) { parsed = meta; }); });
  if (!is_json) return;
  const auto part = [&](const JsonReader& read) {
    faults.attempt([&] { read_parsed_input_json(parsed, path.string(), read); });
  };
  part([&](const Json& meta) {
    if (!meta.is_object()) throw UsageError("an object expected");
    if (!meta.contains("version") || meta["version"] != 1) throw UsageError("\"version\": 1 expected");
  });
  if (!parsed.is_object()) return;
  const std::size_t sizes[] = {frame_count, static_cast<std::size_t>(session.width),
                               static_cast<std::size_t>(session.height)};
  const char* const names[] = {"frames", "width", "height"};
  for (std::size_t i = 0; i < 3; ++i) {
    if (sizes[i] > 0) part([&](const Json& meta) { require_same_size(meta, names[i], sizes[i]); });
  }
  const auto convention = [&](const char* key, std::initializer_list<std::string_view> known) {
    part([&](const Json& meta) { require_convention(meta, key, known); });
  };
  convention("pose_convention", {"opencv_cam_from_world"});
  convention("depth_type", {"z"});
  convention("intrinsics_pixel_origin", {"integer_center", "integer_centre"});
}

/// The arrays beside the depth; `frame_count` is 0 where its size is not known, and they can only be there or not.
void read_other_arrays(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count, bool has_depth,
                       const Faults& faults) {
  if (frame_count == 0) {
    for (const char* name : {"depth_conf", "images", "extrinsic", "intrinsic"})
      faults.attempt([&] { store.read(name); });
    return;
  }
  faults.attempt([&] { read_images(store, session, frame_count); });
  faults.attempt([&] { read_world_points(store, session, frame_count); });
  const bool has_poses = faults.attempt([&] { read_poses(store, session, frame_count); });
  faults.attempt([&] { read_intrinsics(store, session, frame_count); });
  if (has_depth && has_poses) make_first_camera_the_frame(store, session);
}

}  // namespace

SessionPredictions read_session_predictions(const fs::path& folder_or_npz, const Faults& faults) {
  SessionPredictions session;
  const SessionFiles files = find_session_files(folder_or_npz);
  const ArrayStore store(files.arrays);
  std::size_t frame_count = 0;
  const bool has_depth = faults.attempt([&] { read_depth(store, session, frame_count); });
  if (!files.meta.empty()) check_meta(files.meta, session, frame_count, faults);
  faults.attempt([&] { session.frames = read_frames(files.frames, frame_count, faults); });
  read_other_arrays(store, session, frame_count, has_depth, faults);
  for (const std::string& name : store.python_members()) {
    session.warnings.push_back({"skipped_member", fmt::format("{}: {} holds pickled Python objects and was skipped",
                                                              files.arrays.string(), name)});
  }
  return session;
}

PointMap read_point_map(const fs::path& npz) {
  PointMap map;
  const std::string stamp = npz.stem().string();
  if (!parse_number(stamp, map.time_s) || !std::isfinite(map.time_s)) {
    throw InputError(fmt::format("{}: the name is no time stamp", npz.string()));
  }
  const ArrayStore store(npz);
  const NpyArray points = store.read("pointcloud"), mask = store.read("mask");
  std::vector<std::uint64_t> shape = points.shape();
  if (shape.size() != 2 && shape.size() != 3) require_shape(points, {0, 0, 3});
  if (shape.back() != 3 || points.size() == 0)
    require_shape(points, shape.size() == 3 ? std::vector<std::uint64_t>{0, 0, 3} : std::vector<std::uint64_t>{0, 3});
  shape.pop_back();
  require_shape(mask, shape);
  constexpr std::uint64_t kMost = 1U << 30;
  if (shape.back() > kMost || shape.front() > kMost) points.fail("has the absurd shape {}", shape_text(points.shape()));
  map.width = static_cast<int>(shape.back());
  map.height = shape.size() == 2 ? static_cast<int>(shape.front()) : 1;
  map.mask = mask.to_bytes();
  const Array<float> values = points.to_floats();
  map.points.resize(map.mask.size());
  for (std::size_t i = 0; i < map.mask.size(); ++i) {
    map.points[i] = Eigen::Map<const Eigen::Vector3f>(values.data() + 3 * i);
    map.mask[i] = map.mask[i] != 0 && map.points[i].allFinite() ? 1 : 0;
  }
  return map;
}

}  // namespace cmap
