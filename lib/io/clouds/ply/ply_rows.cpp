#include "clouds/ply/ply_rows.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

namespace cmap {

PlyRowWalker::PlyRowWalker(ByteSource& source, const PlyElement& element, bool swap_bytes)
    : source_(source), what_("a row of element '" + element.name + "'"), swap_bytes_(swap_bytes) {
  for (const Field& field : element.properties) {
    const std::size_t bytes = scalar_bytes(field.type);
    if (field.list_count_type) {
      steps_.push_back({0, *field.list_count_type, bytes});
      continue;
    }
    if (steps_.empty() || steps_.back().item_bytes > 0) steps_.push_back({});
    steps_.back().run_bytes += bytes;
    packed_bytes_ += bytes;
  }
  if (packed_bytes_ > ByteSource::kMaxRecordBytes) {
    source.fail("header: {} takes more than the accepted {} bytes", what_, ByteSource::kMaxRecordBytes);
  }
}

void PlyRowWalker::next(std::byte* packed) {
  for (const Step& step : steps_) {
    if (step.item_bytes > 0) {
      // A count has at most 32 bits, so the product cannot overflow.
      source_.skip(read_count(step.count_type) * step.item_bytes, what_);
    } else if (packed != nullptr) {
      source_.read({packed, step.run_bytes}, what_);
      packed += step.run_bytes;
    } else {
      source_.skip(step.run_bytes, what_);
    }
  }
}

std::uint64_t PlyRowWalker::read_count(ScalarType type) {
  return visit_scalar(type, [&](auto value) -> std::uint64_t {
    using Count = decltype(value);
    if constexpr (std::is_integral_v<Count>) {
      std::array<std::byte, sizeof(Count)> bytes;
      source_.read(bytes, what_);
      if (swap_bytes_) std::reverse(bytes.begin(), bytes.end());
      std::memcpy(&value, bytes.data(), sizeof(Count));
      if constexpr (std::is_signed_v<Count>) {
        if (value < 0) source_.fail("byte {}: a list of length {}", source_.position() - sizeof(Count), value);
      }
      return static_cast<std::uint64_t>(value);
    }
    return 0;  // the header refuses floating-point lengths
  });
}

}  // namespace cmap
