#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "clouds/color_store.hpp"
#include "clouds/columns.hpp"
#include "clouds/position_store.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// What a file's points are made of.
struct CloudLayout {
  bool wide = false;  ///< coordinates need double until the origin is known (anything but float32)
  ColorDeclaration color;
};

/// Collects the points of a file: drops and counts those that are not finite, leaves out those that no sensor measured
/// (a coordinate of kNoReturn_m or more; many points exactly at 0 0 0), decides what the colors mean (ColorStore),
/// chooses the origin. Memory grows with max_points, which the reader must have checked against the file size.
class CloudBuilder {
 public:
  /// Coordinates that writers put where there was no return: 1e9, FLT_MAX, ...
  static constexpr double kNoReturn_m = 1e9;

  CloudBuilder(const ByteSource& source, CloudLayout layout, std::uint64_t max_points);

  /// Adds n points. Throws InputError for a number that no color has.
  void append(const PointColumns& columns, std::size_t n);
  /// Counts n points that the reader does not append, and why ("withheld").
  void leave_out(std::string_view reason, std::uint64_t n);
  /// What the reader saw of packed colors that it has taken apart.
  void add_packed(const PackedFloats& packed) { colors_.add_packed(packed); }
  std::uint64_t seen() const { return seen_; }

  /// The cloud; fills in what `info` says of points and colors. Throws InputError if no point is left.
  PointCloud finish(FileInfo& info);

 private:
  template <class Positions>
  void append_piece(Positions& positions, const PointColumns& columns, std::size_t first, std::size_t n);
  template <class Real>
  std::size_t filter(Real* xyz, std::size_t n);
  void count_left_out(std::string_view reason, std::uint64_t n);
  void drop_many_zeros();
  void describe(FileInfo& info);

  const ByteSource& source_;
  std::uint64_t max_points_;
  std::variant<FloatPositions, DoublePositions> positions_;
  ColorStore colors_;
  Box3d box_;                    ///< of the points that are not exactly at 0 0 0
  std::uint64_t n_at_zero_ = 0;  ///< kept
  std::uint64_t n_no_return_ = 0;
  std::uint64_t seen_ = 0;
  std::vector<LeftOut> left_out_;
  std::size_t kept_ = 0;
  std::vector<std::uint32_t> kept_rows_;  ///< of the piece at hand, where not all stay
};

}  // namespace cmap
