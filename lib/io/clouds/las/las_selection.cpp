#include "clouds/las/las_selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "bytes/little_endian.hpp"

namespace cmap {
namespace {

// Records looked at and then decoded while they are still in the nearest cache.
constexpr std::size_t kRecordsAtOnce = 512;

constexpr std::size_t kFlagsAt = 15;  // in a record of any format
constexpr std::int32_t kLowestInteger = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t kHighestInteger = std::numeric_limits<std::int32_t>::max();

// Fewer points at an end of an axis's integers may be those that the axis was scaled to fit.
constexpr double kSuspiciousShare = 0.01;

std::int32_t raw_coordinate(const std::byte* record, std::size_t axis) {
  return load_little<std::int32_t>({record + 4 * axis, 4}, 0);
}

bool is_end(std::int32_t raw) {
  return static_cast<std::uint32_t>(raw) - static_cast<std::uint32_t>(kHighestInteger) <= 1U;
}

}  // namespace

LasSelection::LasSelection(const LasHeader& header, const ReadOptions& options)
    : record_bytes_(header.record_bytes), classes_(options.classes) {
  // Formats 0 to 5 keep class and flags in one byte, the others in two.
  class_at_ = header.extended_format() ? kFlagsAt + 1 : kFlagsAt;
  class_mask_ = header.extended_format() ? 0xff : 0x1f;
  withheld_mask_ = header.extended_format() ? 0x04 : 0x80;
  for (unsigned byte = 0; byte < 256; ++byte) {
    of_class_byte_[byte] = verdict_of_class(byte & class_mask_, options.keep_noise);
  }
}

LasSelection::Verdict LasSelection::verdict_of_class(unsigned number, bool keep_noise) const {
  if (!classes_.empty()) return std::ranges::count(classes_, number) > 0 ? kKept : kOtherClass;
  if (keep_noise) return kKept;
  return number == 7 ? kNoise7 : number == 18 ? kNoise18 : kKept;
}

LasSelection::Verdict LasSelection::verdict(const std::byte* record) const {
  const bool lowest = raw_coordinate(record, 0) == kLowestInteger && raw_coordinate(record, 1) == kLowestInteger &&
                      raw_coordinate(record, 2) == kLowestInteger;
  if (lowest) return kNoNumber;
  if ((static_cast<std::uint8_t>(record[kFlagsAt]) & withheld_mask_) != 0) return kWithheld;
  return of_class_byte_[static_cast<std::uint8_t>(record[class_at_])];
}

void LasSelection::append(const std::byte* data, std::size_t n, const RecordLayout& layout, CloudBuilder& builder) {
  for (std::size_t first = 0; first < n; first += kRecordsAtOnce) {
    const std::byte* piece = data + first * record_bytes_;
    const std::size_t count = std::min(kRecordsAtOnce, n - first);
    n_ += count;
    if (needs_a_look(piece, count)) {
      look(piece, count, layout, builder);
    } else {
      n_kept_ += count;
      builder.append(columns_at(layout, piece), count);
    }
  }
}

/// Whether any record may have to be left out or counted; without a branch a record, as nearly none has.
bool LasSelection::needs_a_look(const std::byte* data, std::size_t n) const {
  unsigned any = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::byte* record = data + i * record_bytes_;
    any |= static_cast<unsigned>(record[kFlagsAt]) & withheld_mask_;
    any |= of_class_byte_[static_cast<std::uint8_t>(record[class_at_])];
    for (std::size_t axis = 0; axis < 3; ++axis) any |= is_end(raw_coordinate(record, axis)) ? 1U : 0U;
  }
  return any != 0;
}

void LasSelection::look(const std::byte* data, std::size_t n, const RecordLayout& layout, CloudBuilder& builder) {
  std::array<std::uint64_t, kVerdicts> counts{};
  kept_records_.clear();
  std::size_t run = 0;  // first of the kept records that are not copied yet
  const auto copy_until = [&](std::size_t end) {
    kept_records_.insert(kept_records_.end(), data + run * record_bytes_, data + end * record_bytes_);
    run = end + 1;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::byte* record = data + i * record_bytes_;
    const Verdict found = verdict(record);
    ++counts[found];
    ++n_of_class_[static_cast<std::uint8_t>(record[class_at_]) & class_mask_];
    if (found == kKept) {
      count_ends(record);
    } else {
      copy_until(i);
    }
  }
  copy_until(n);
  n_kept_ += counts[kKept];
  n_no_number_ += counts[kNoNumber];
  if (counts[kKept] > 0) builder.append(columns_at(layout, kept_records_.data()), counts[kKept]);
  for (const Verdict left_out : {kNoNumber, kWithheld, kNoise7, kNoise18, kOtherClass}) {
    if (counts[left_out] > 0) builder.leave_out(reason(left_out), counts[left_out]);
  }
}

void LasSelection::count_ends(const std::byte* record) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int32_t raw = raw_coordinate(record, axis);
    if (is_end(raw)) ++(raw == kLowestInteger ? n_lowest_ : n_highest_)[axis];
  }
}

std::string LasSelection::reason(Verdict verdict) const {
  switch (verdict) {
    case kNoNumber:
      return "not a number when written (three lowest integers)";
    case kWithheld:
      return "withheld";
    case kNoise7:
      return "noise class 7";
    case kNoise18:
      return "noise class 18";
    default:
      return fmt::format("not of class {}", fmt::join(classes_, ", "));
  }
}

void LasSelection::check(const ByteSource& source, FileInfo& info) const {
  if (n_no_number_ == n_) {
    source.fail("every coordinate stands at {}, the lowest integer: the offsets were lost on writing", kLowestInteger);
  }
  if (n_kept_ == 0 && !classes_.empty()) refuse_classes(source);
  for (std::size_t axis = 0; axis < 3; ++axis) check_axis(axis, source, info);
}

void LasSelection::refuse_classes(const ByteSource& source) const {
  std::vector<std::size_t> present;
  for (std::size_t k = 0; k < n_of_class_.size(); ++k) {
    if (n_of_class_[k] > 0) present.push_back(k);
  }
  throw UnsupportedError(fmt::format("{}: no point of class {} (that is not withheld); its points are of class {}",
                                     source.name(), fmt::join(classes_, ", "), fmt::join(present, ", ")));
}

void LasSelection::check_axis(std::size_t axis, const ByteSource& source, FileInfo& info) const {
  const bool lowest = n_lowest_[axis] > n_highest_[axis];
  const std::uint64_t n = lowest ? n_lowest_[axis] : n_highest_[axis];
  if (n > 0 && n == n_kept_) {
    source.fail("{} stands at {}, the end of its integers, at every point: its offset was lost on writing", "xyz"[axis],
                lowest ? kLowestInteger : kHighestInteger);
  }
  if (static_cast<double>(n) <= kSuspiciousShare * static_cast<double>(n_kept_)) return;
  info.warnings.push_back(
      {"cut_off_coordinates", fmt::format("{} of {} points stand at the end of the integers of {}: the writer cut off "
                                          "what scale and offset cannot hold",
                                          n, n_kept_, "xyz"[axis])});
}

}  // namespace cmap
