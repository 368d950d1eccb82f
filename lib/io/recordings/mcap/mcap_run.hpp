#pragma once

#include "cmap/core/array.hpp"
#include "recordings/mcap/mcap_layout.hpp"

namespace cmap::mcap {

/// A message in an opened run.
struct Entry {
  std::int64_t log_time_ns = 0;
  std::uint64_t place = 0;  ///< of the record in the run
  std::uint16_t channel = 0;
  std::span<const std::byte> data;
};

/// The messages of a run, in memory by log time.
class OpenRun {
 public:
  /// Channels that it brings along are added. Throws InputError naming file and place.
  void open(const ByteSource& source, const Run& run, Channels& channels);

  bool is_done() const { return next_ == entries_.size(); }
  const Entry& front() const { return entries_[next_]; }
  void pop() { ++next_; }
  const std::vector<Entry>& entries() const { return entries_; }
  const Run& run() const { return run_; }
  std::size_t bytes() const { return packed_.size() + unpacked_.size(); }

 private:
  void take(std::span<const std::byte> records, Channels& channels);

  Run run_;
  Array<std::byte> packed_, unpacked_;
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
};

}  // namespace cmap::mcap
