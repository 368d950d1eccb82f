#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "clouds/cloud_builder.hpp"
#include "clouds/las/las_header.hpp"
#include "clouds/record_reader.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// Hands on the records of a LAS file that are points of the map. What is withheld, noise, of a class that was not
/// asked for, or no number at all is left out and counted by reason. Not thread-safe.
class LasSelection {
 public:
  LasSelection(const LasHeader& header, const ReadOptions& options);

  /// The n records at `data`, which are laid out as `layout` says.
  void append(const std::byte* data, std::size_t n, const RecordLayout& layout, CloudBuilder& builder);
  /// After the last record. Throws InputError where an axis stands at the end of its integers throughout,
  /// UnsupportedError where no point is of the classes that were asked for; warns where many stand at such an end.
  void check(const ByteSource& source, FileInfo& info) const;

 private:
  enum Verdict : std::uint8_t { kKept, kNoNumber, kWithheld, kNoise7, kNoise18, kOtherClass, kVerdicts };

  Verdict verdict_of_class(unsigned number, bool keep_noise) const;
  Verdict verdict(const std::byte* record) const;
  bool needs_a_look(const std::byte* data, std::size_t n) const;
  void look(const std::byte* data, std::size_t n, const RecordLayout& layout, CloudBuilder& builder);
  void count_ends(const std::byte* record);
  std::string reason(Verdict verdict) const;
  [[noreturn]] void refuse_classes(const ByteSource& source) const;
  void check_axis(std::size_t axis, const ByteSource& source, FileInfo& info) const;

  std::size_t record_bytes_;
  std::size_t class_at_;  ///< in a record
  std::uint8_t class_mask_, withheld_mask_;
  std::vector<std::uint8_t> classes_;  ///< asked for; empty: all
  std::array<Verdict, 256> of_class_byte_{};
  std::vector<std::byte> kept_records_;          ///< of the piece at hand
  std::array<std::uint64_t, 256> n_of_class_{};  ///< of the records that needed a look
  std::uint64_t n_ = 0, n_kept_ = 0, n_no_number_ = 0;
  std::array<std::uint64_t, 3> n_lowest_{}, n_highest_{};  ///< kept points at the ends of an axis's integers
};

}  // namespace cmap
