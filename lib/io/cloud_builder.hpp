#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "cmap/core/point_cloud.hpp"
#include "cmap/io/point_cloud_file.hpp"
#include "io/byte_source.hpp"
#include "io/columns.hpp"
#include "io/position_store.hpp"

namespace cmap {

/// What a file's points are made of.
struct CloudLayout {
  bool wide = false;  ///< coordinates need double until the origin is known (anything but float32)
  ColorStorage color = ColorStorage::kNone;
  std::array<std::string, 3> color_names{"red", "green", "blue"};  ///< the file's own, for messages
};

/// Collects the points of a file: drops and counts those that are not finite (in position or float color), checks
/// ranges, chooses the origin. Memory grows with max_points, which the reader must have checked against the file size.
class CloudBuilder {
 public:
  CloudBuilder(const ByteSource& source, CloudLayout layout, std::uint64_t max_points);

  /// Adds n points. Throws InputError for a coordinate beyond kMaxCoordinate_m or a float color outside [0,1].
  void append(const PointColumns& columns, std::size_t n);
  /// Counts n points that the reader does not append, and why ("withheld").
  void leave_out(std::string_view reason, std::uint64_t n);
  std::uint64_t seen() const { return seen_; }

  /// The cloud; fills in the counts of `info`. Throws InputError if no point is left.
  PointCloud finish(FileInfo& info);

 private:
  template <class Positions>
  void append_piece(Positions& positions, const PointColumns& columns, std::size_t first, std::size_t n);
  template <class Real>
  std::size_t filter(Real* xyz, std::size_t n);
  void decode_piece_colors(const PointColumns& columns, std::size_t first, std::size_t n);
  bool colors_fit(std::size_t n) const;
  bool color_is_finite(std::size_t i) const;
  void check_color(std::size_t i) const;

  const ByteSource& source_;
  CloudLayout layout_;
  std::uint64_t max_points_;
  std::variant<FloatPositions, DoublePositions> positions_;
  Colors colors_;
  Box3d box_;
  std::uint64_t seen_ = 0;
  std::vector<LeftOut> left_out_;
  std::size_t kept_ = 0;
};

}  // namespace cmap
