#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bytes/csv_writer.hpp"
#include "cmap/io/output_folder.hpp"
#include "cmap/io/session_file.hpp"
#include "containers/npy_array.hpp"

namespace cmap {
namespace {

using Shape = std::vector<std::uint64_t>;

void check_sizes(const SessionPredictions& session) {
  const std::size_t pixels = session.frame_count() * session.pixels_per_frame();
  const auto is = [&](std::size_t size, std::size_t expected) {
    if (size != expected) throw std::invalid_argument("write_session_predictions: arrays of different lengths");
  };
  is(session.images.size(), pixels);
  is(session.depth.size(), pixels);
  is(session.depth_confidence.size(), pixels);
  is(session.T_camera_session.size(), session.frame_count());
  is(session.intrinsics.size(), session.frame_count());
  is(session.world_points_confidence.size(), session.world_points.size());
  if (!session.world_points.empty()) is(session.world_points.size(), pixels);
}

void write_array(const std::filesystem::path& path, ScalarType type, const Shape& shape, const void* data) {
  OutputFile file(path);
  write_npy(file, type, shape, data);
  file.commit();
}

void write_cameras(const SessionPredictions& session, const std::filesystem::path& folder) {
  std::vector<double> poses, matrices;
  for (std::size_t i = 0; i < session.frame_count(); ++i) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) poses.push_back(session.T_camera_session[i](row, column));
      for (int column = 0; column < 3; ++column) matrices.push_back(session.intrinsics[i](row, column));
    }
  }
  write_array(folder / "extrinsic.npy", ScalarType::kFloat64, {session.frame_count(), 3, 4}, poses.data());
  write_array(folder / "intrinsic.npy", ScalarType::kFloat64, {session.frame_count(), 3, 3}, matrices.data());
}

void write_frames(const SessionPredictions& session, double time_offset_s, const std::filesystem::path& path) {
  OutputFile file(path);
  file.write("index,timestamp_s,image_name,orig_w,orig_h\n");
  for (const PredictionFrame& frame : session.frames) {
    file.write(fmt::format("{},{},{},{},{}\n", frame.index, frame.time_s - time_offset_s, csv_cell(frame.image_name),
                           frame.original_width, frame.original_height));
  }
  file.commit();
}

void write_meta(const SessionPredictions& session, const std::filesystem::path& path) {
  const nlohmann::ordered_json meta = {{"version", 1},
                                       {"frames", session.frame_count()},
                                       {"width", session.width},
                                       {"height", session.height},
                                       {"pose_convention", "opencv_cam_from_world"},
                                       {"depth_type", "z"},
                                       {"intrinsics_pixel_origin", "integer_center"}};
  OutputFile file(path);
  file.write(meta.dump(1) + "\n");
  file.commit();
}

}  // namespace

void write_session_predictions(const SessionPredictions& session, const std::filesystem::path& folder,
                               double time_offset_s) {
  check_sizes(session);
  OutputFolder output(folder);
  const std::filesystem::path& partial = output.partial();
  const Shape pixels{session.frame_count(), static_cast<std::uint64_t>(session.height),
                     static_cast<std::uint64_t>(session.width)};
  Shape triples = pixels;
  triples.push_back(3);
  write_frames(session, time_offset_s, partial / "frames.csv");
  write_array(partial / "images.npy", ScalarType::kUint8, triples, session.images.data());
  write_array(partial / "depth.npy", ScalarType::kFloat32, pixels, session.depth.data());
  write_array(partial / "depth_conf.npy", ScalarType::kFloat32, pixels, session.depth_confidence.data());
  if (!session.world_points.empty()) {
    write_array(partial / "world_points.npy", ScalarType::kFloat32, triples, session.world_points.data());
    write_array(partial / "world_points_conf.npy", ScalarType::kFloat32, pixels,
                session.world_points_confidence.data());
  }
  write_cameras(session, partial);
  write_meta(session, partial / "meta.json");
  output.commit();
}

}  // namespace cmap
