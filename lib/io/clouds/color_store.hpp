#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "clouds/columns.hpp"
#include "clouds/packed_floats.hpp"
#include "cmap/geometry/point_cloud.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// How far beyond white fractions may reach by rounding and interpolation, as a factor: a picture resampled with a
/// bicubic filter reaches 5 %.
inline constexpr float kColorOvershoot = 1.06F;

/// How a file declares its colors.
struct ColorDeclaration {
  ColorStorage storage = ColorStorage::kNone;
  std::optional<ScalarType> type = {};                       ///< of the channels; none where a file does not say (text)
  std::array<std::string, 3> names{"red", "green", "blue"};  ///< the file's own, for messages
};

/// The colors of a file on their way in, and the one rule, for all formats, of what their numbers mean.
///
/// Numbers are kept as bytes as long as bytes hold them, else as 16 bits, else as floats, so that nothing is converted
/// twice. The whole file decides: the highest value says whether 1, 255 or 65535 is white (fractions a little above
/// are overshoots and are cut), 16-bit values whose low bytes are all zero are 8-bit ones times 256, and where nothing
/// but black is stored there are no colors. A channel that is not finite makes its point one without color (NaN).
class ColorStore {
 public:
  ColorStore(ColorDeclaration declaration, std::uint64_t max_points);

  /// Decodes n colors (at most kPiece) from row `first` on; `kept` names the rows of these that stay, where not all do.
  /// `point` is the number of the first, counted from 0, for messages. Throws InputError for a number no color has.
  void append(const ByteSource& source, const PointColumns& columns, std::size_t first, std::size_t n,
              const std::vector<std::uint32_t>* kept, std::uint64_t point);
  static constexpr std::size_t kPiece = 2048;

  /// What the reader saw of packed colors that it has taken apart.
  void add_packed(const PackedFloats& packed) { packed_.add(packed); }

  /// Keeps the colors with keep[i] != 0.
  void select(const Array<std::uint8_t>& keep);

  /// The colors of all points; notes what was decided and warns of what cannot be right.
  Colors finish(const ByteSource& source, FileInfo& info);

 private:
  void append_bytes(const PointColumns& columns, std::size_t first, std::size_t n,
                    const std::vector<std::uint32_t>* kept);
  void append_shorts(const PointColumns& columns, std::size_t first, std::size_t n,
                     const std::vector<std::uint32_t>* kept);
  void append_floats(const ByteSource& source, const PointColumns& columns, std::size_t first, std::size_t n,
                     const std::vector<std::uint32_t>* kept, std::uint64_t point);
  void store_floats(const float* rgb, std::size_t n, bool whole);
  void widen_to_shorts();
  void widen_to_floats();
  void set_white(float white);
  void check_lowest(const ByteSource& source) const;
  void settle(FileInfo& info);
  void cut_overshoots(FileInfo& info);

  ColorDeclaration declaration_;
  std::uint64_t max_points_;
  Colors colors_;  ///< room for max_points_
  std::size_t size_ = 0;
  float white_ = 0.0F;  ///< the number that floats were divided by; 0 as long as there are none
  float highest_ = 0.0F, lowest_ = 0.0F;
  std::uint64_t lowest_point_ = 0;
  std::size_t lowest_channel_ = 0;
  std::uint32_t bits_ = 0;  ///< of all whole numbers
  std::uint64_t n_without_color_ = 0;
  PackedFloats packed_;
};

}  // namespace cmap
