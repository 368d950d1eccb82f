#pragma once

#include "cmap/io/byte_source.hpp"
#include "recordings/containers/message_store.hpp"

namespace cmap {

/// An MCAP file. Indexes are not read: its records are, so that files without any, or with a damaged one, are the same.
/// Chunks that overlap in time are merged; one that is damaged is an error where its messages come.
std::unique_ptr<MessageStore> open_mcap(std::unique_ptr<ByteSource> source);

}  // namespace cmap
