#include "captures/session_arrays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "captures/picture_fit.hpp"
#include "cmap/geometry/order_statistics.hpp"
#include "poses/written_rotation.hpp"

namespace cmap {
namespace {

using Shape = std::vector<std::uint64_t>;

/// Where value i of an (S,H,W) array lies, for messages.
std::string pixel_text(const SessionPredictions& session, std::size_t i) {
  const auto width = static_cast<std::size_t>(session.width);
  const std::size_t in_frame = i % session.pixels_per_frame();
  return fmt::format("frame {}, row {}, column {}", i / session.pixels_per_frame(), in_frame / width, in_frame % width);
}

Shape pixel_shape(const SessionPredictions& session, std::size_t frame_count) {
  return {frame_count, static_cast<std::uint64_t>(session.height), static_cast<std::uint64_t>(session.width)};
}

NpyArray read_of(const ArrayStore& store, std::string_view name, std::size_t dimensions) {
  NpyArray array = store.read(name);
  drop_ones(array, dimensions);
  return array;
}

NpyArray read_pixels(const ArrayStore& store, std::string_view name) { return read_of(store, name, 3); }

/// Marks what is no measurement with 0 in both arrays and says how many; throws InputError if nothing is left.
void mark_invalid_depth(const std::string& name, SessionPredictions& session) {
  std::size_t invalid = 0;
  for (std::size_t i = 0; i < session.depth.size(); ++i) {
    float& depth = session.depth[i];
    float& confidence = session.depth_confidence[i];
    if (depth < 0.0F) {
      throw InputError(fmt::format("{}: {:g} at {}; depths are positive", name, depth, pixel_text(session, i)));
    }
    if (std::isfinite(depth) && depth > 0.0F && std::isfinite(confidence)) continue;
    depth = confidence = 0.0F;
    ++invalid;
  }
  if (invalid == session.depth.size()) throw InputError(name + ": no pixel has a finite positive depth and confidence");
  if (invalid > 0) {
    session.warnings.push_back({"invalid_depth", fmt::format("{}: {} of {} pixels have no finite positive depth and "
                                                             "confidence; they count as not seen",
                                                             name, invalid, session.depth.size())});
  }
}

void note_low_confidence(const std::string& name, const Array<float>& confidence, SessionPredictions& session) {
  const auto low = std::count_if(confidence.begin(), confidence.end(), [](float c) { return c != 0.0F && c < 1.0F; });
  if (low == 0) return;
  session.warnings.push_back(
      {"confidence_below_one", fmt::format("{}: {} of {} confidences are below 1, the least that "
                                           "VGGT gives",
                                           name, low, confidence.size())});
}

Eigen::Matrix3d intrinsics_of(const NpyArray& array, const double* values, std::size_t frame) {
  const Eigen::Matrix3d K = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values);
  constexpr double kTolerance = 1e-6;
  const bool triangular = K.allFinite() && K(0, 0) > 0.0 && K(1, 1) > 0.0 && std::abs(K(1, 0)) <= kTolerance &&
                          std::abs(K(2, 0)) <= kTolerance && std::abs(K(2, 1)) <= kTolerance &&
                          std::abs(K(2, 2) - 1.0) <= kTolerance;
  if (!triangular) array.fail("frame {}: no camera matrix [fx s cx; 0 fy cy; 0 0 1]", frame);
  return K;
}

Eigen::Isometry3d pose_of(const NpyArray& array, const double* values, std::size_t frame) {
  const Eigen::Matrix<double, 3, 4> matrix = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(values);
  const double deviation = deviation_from_rotation(matrix.leftCols<3>());
  if (!(deviation <= kRotationTolerance) || !matrix.allFinite()) {
    array.fail(
        "frame {}: no rotation and translation: |R^T R - I| = {:g}, det R = {:g}; {:g} and 1 expected", frame,
        (matrix.leftCols<3>().transpose() * matrix.leftCols<3>() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
        matrix.leftCols<3>().determinant(), kRotationTolerance);
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = nearest_rotation(matrix.leftCols<3>());
  pose.translation() = matrix.col(3);
  return pose;
}

float median_depth(const SessionPredictions& session) {
  Array<float> depths;
  std::copy_if(session.depth.begin(), session.depth.end(), std::back_inserter(depths),
               [](float d) { return d > 0.0F; });
  return upper_median(depths);
}

/// What values from `low` to `high` probably are, in place of [0,1].
std::string_view range_hint(float low, float high) {
  if (low >= 0.0F && high <= 255.0F) return "; are these 0 to 255? Divide by 255";
  if (low >= -1.0F && high <= 1.0F) return "; are these -1 to 1? Take (x + 1) / 2";
  if (low >= -2.2F && high <= 2.7F) return "; were they normalized for a network? Undo that";
  return "";
}

/// Float pictures as bytes. Resizing by bicubic or Lanczos interpolation oversteps [0,1] a little.
Array<std::uint8_t> to_bytes(const NpyArray& images, SessionPredictions& session) {
  constexpr float kOverstep = 0.25F;
  const Array<float> values = images.to_floats();
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto odd = std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
  if (odd != values.end()) images.fail("holds {:g}; float images lie in [0,1]", *odd);
  const float excess = std::max(-*low, *high - 1.0F);
  if (excess > kOverstep) {
    images.fail("holds {:g}; float images lie in [0,1]{}", excess == -*low ? *low : *high, range_hint(*low, *high));
  }
  Array<std::uint8_t> bytes(values.size());
  std::size_t n_outside = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float value = std::clamp(values[i], 0.0F, 1.0F);
    if (value != values[i]) ++n_outside;
    bytes[i] = static_cast<std::uint8_t>(std::lround(value * 255.0F));
  }
  if (n_outside > 0) {
    session.warnings.push_back(
        {"clamped_picture", fmt::format("{}: {} of {} values are outside [0,1], by up to {:.2g}; they count as 0 or 1",
                                        images.name, n_outside, values.size(), excess)});
  }
  return bytes;
}

/// (S,H,W,3) or (S,3,H,W), bytes or floats in [0,1].
void set_colors(const NpyArray& images, std::uint64_t frames, SessionPredictions& session) {
  const auto height = static_cast<std::uint64_t>(session.height), width = static_cast<std::uint64_t>(session.width);
  const bool planes = images.shape() == Shape{frames, 3, height, width};
  if (!planes && images.shape() != Shape{frames, height, width, 3}) {
    images.fail("has the shape {}; {} or {} expected", shape_text(images.shape()),
                shape_text({frames, height, width, 3}), shape_text({frames, 3, height, width}));
  }
  const bool bytes = images.header.fields[0].type == "|u1";
  const Array<std::uint8_t> values = bytes ? images.to_bytes() : to_bytes(images, session);
  const std::size_t pixels = height * width;
  session.images.resize(frames * pixels);
  for (std::size_t i = 0; i < session.images.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      session.images[i][k] = values[planes ? (3 * (i / pixels) + k) * pixels + i % pixels : 3 * i + k];
    }
  }
}

}  // namespace

void read_depth(const ArrayStore& store, SessionPredictions& session, std::size_t& frame_count) {
  constexpr std::uint64_t kMostPixels = 1 << 16;  // of a side
  const NpyArray depth = read_pixels(store, "depth");
  require_shape(depth, {0, 0, 0});
  const Shape& shape = depth.shape();
  if (depth.size() == 0) depth.fail("has the shape {}: no frame or no pixel", shape_text(shape));
  if (shape[1] > kMostPixels || shape[2] > kMostPixels) depth.fail("has the absurd shape {}", shape_text(shape));
  frame_count = shape[0];
  session.height = static_cast<int>(shape[1]);
  session.width = static_cast<int>(shape[2]);
  session.depth = depth.to_floats();
  const NpyArray confidence = read_pixels(store, "depth_conf");
  require_shape(confidence, shape);
  session.depth_confidence = confidence.to_floats();
  mark_invalid_depth(depth.name, session);
  note_low_confidence(confidence.name, session.depth_confidence, session);
}

void read_images(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count) {
  set_colors(read_of(store, "images", 4), frame_count, session);
}

void read_intrinsics(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count) {
  const NpyArray intrinsic = read_of(store, "intrinsic", 3);
  require_shape(intrinsic, {frame_count, 3, 3});
  const Array<double> matrices = intrinsic.to_doubles();
  for (std::size_t i = 0; i < frame_count; ++i) {
    const Eigen::Matrix3d K = intrinsics_of(intrinsic, matrices.data() + 9 * i, i);
    const std::string doubt = principal_point_doubt(K(0, 2), K(1, 2), session.width, session.height);
    if (!doubt.empty()) intrinsic.fail("frame {}: {}", i, doubt);
    session.intrinsics.push_back(K);
  }
}

void read_poses(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count) {
  const NpyArray extrinsic = read_of(store, "extrinsic", 3);
  const bool is_square = extrinsic.shape() == Shape{frame_count, 4, 4};
  if (!is_square) require_shape(extrinsic, {frame_count, 3, 4});
  const Array<double> values = extrinsic.to_doubles();
  for (std::size_t i = 0; i < frame_count; ++i) {
    const double* const matrix = values.data() + (is_square ? 16 : 12) * i;
    if (is_square && !std::equal(matrix + 12, matrix + 16, std::array{0.0, 0.0, 0.0, 1.0}.begin())) {
      extrinsic.fail("frame {}: the last row is not 0 0 0 1", i);
    }
    session.T_camera_session.push_back(pose_of(extrinsic, matrix, i));
  }
}

void read_world_points(const ArrayStore& store, SessionPredictions& session, std::size_t frame_count) {
  if (!store.has("world_points") && !store.has("world_points_conf")) return;
  const NpyArray points = read_of(store, "world_points", 4), confidence = read_pixels(store, "world_points_conf");
  Shape shape = pixel_shape(session, frame_count);
  require_shape(confidence, shape);
  shape.push_back(3);
  require_shape(points, shape);
  const Array<float> values = points.to_floats();
  session.world_points_confidence = confidence.to_floats();
  session.world_points.resize(confidence.size());
  std::size_t invalid = 0;
  for (std::size_t i = 0; i < confidence.size(); ++i) {
    session.world_points[i] = Eigen::Map<const Eigen::Vector3f>(values.data() + 3 * i);
    if (session.world_points[i].allFinite() && std::isfinite(session.world_points_confidence[i])) continue;
    session.world_points[i].setZero();
    session.world_points_confidence[i] = 0.0F;
    ++invalid;
  }
  if (invalid > 0) {
    session.warnings.push_back({"invalid_points", fmt::format("{}: {} of {} points are not finite; they count as not "
                                                              "seen",
                                                              points.name, invalid, confidence.size())});
  }
  note_low_confidence(confidence.name, session.world_points_confidence, session);
}

void make_first_camera_the_frame(const ArrayStore& store, SessionPredictions& session) {
  constexpr double kAngle_deg = 2.0, kDepths = 0.05;  // far more than VGGT's own
  const Eigen::Isometry3d T_first_session = session.T_camera_session.front();
  const double angle_deg = Eigen::AngleAxisd(T_first_session.linear()).angle() * 180.0 / std::numbers::pi;
  const double depths = T_first_session.translation().norm() / static_cast<double>(median_depth(session));
  if (angle_deg > kAngle_deg || depths > kDepths) {
    session.warnings.push_back({"first_camera_not_identity",
                                fmt::format("{}: the first camera is {:.3g} deg and {:.3g} median depths away from the "
                                            "session's frame; is frame 0 the first of the session?",
                                            store.name_of("extrinsic"), angle_deg, depths)});
  }
  const Eigen::Isometry3d T_session_first = T_first_session.inverse();
  for (Eigen::Isometry3d& pose : session.T_camera_session) pose = pose * T_session_first;
  session.T_camera_session.front() = Eigen::Isometry3d::Identity();
  session.T_session_file = T_first_session;
  const Eigen::Isometry3f T = T_first_session.cast<float>();
  for (Eigen::Vector3f& point : session.world_points) point = T * point;
}

}  // namespace cmap
