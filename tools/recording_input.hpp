#pragma once

// Programs that take a recording in place of a capture, by unpacking it first.

#include <fmt/format.h>

#include <string>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/io/unpack_recording.hpp"
#include "command_line.hpp"
#include "files.hpp"

namespace cmap {

struct RecordingArguments {
  std::string rig;     ///< calibration and topics
  std::string unpack;  ///< folder to unpack to; it stays
};

inline void add_recording_options(CommandLine& line, RecordingArguments& a) {
  line.add("--rig", a.rig, "FILE", "calibration and topics of a recording in place of CAPTURE").not_empty();
  line.add("--unpack", a.unpack, "DIR", "folder that a recording is unpacked to, a capture that stays").not_empty();
}

/// The folder of the capture to read: `input`, or what a recording was unpacked to.
inline std::string capture_of(const std::string& input, const RecordingArguments& a, const Execution& execution) {
  if (!is_recording(input)) {
    if (!a.rig.empty() || !a.unpack.empty()) throw UsageError("--rig and --unpack are for recordings");
    return input;
  }
  if (a.rig.empty() || a.unpack.empty()) {
    throw UsageError(
        fmt::format("{}: a recording: --rig FILE says how its sensors sit, --unpack DIR where it is unpacked "
                    "to",
                    input));
  }
  const ExecutionScope scope(execution);
  const UnpackedRecording found = unpack_recording(input, read_recording_configuration(a.rig), a.unpack);
  print_warnings(found.warnings);
  return a.unpack;
}

}  // namespace cmap
