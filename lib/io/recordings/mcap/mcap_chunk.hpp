#pragma once

#include "cmap/core/array.hpp"
#include "recordings/mcap/mcap_records.hpp"

namespace cmap::mcap {

/// The records of a chunk, their checksum compared where there is one: unpacked into `room`, or where they are if they
/// are not compressed. Throws InputError with the reason alone; UnsupportedError for a compression that this build
/// cannot read.
std::span<const std::byte> unpack_chunk(const ChunkStart& start, std::span<const std::byte> packed,
                                        Array<std::byte>& room);

/// Throws InputError where the bytes are not what the checksum says; 0: there is none.
void check_crc(std::uint32_t crc, std::span<const std::byte> bytes);

}  // namespace cmap::mcap
