#include "cmap/io/row_writer.hpp"

#include <bit>

namespace cmap {

static_assert(std::endian::native == std::endian::little, "the writers copy values as they lie in memory");

void RowWriter::flush() {
  file_.write(block_);
  block_.clear();
}

}  // namespace cmap
