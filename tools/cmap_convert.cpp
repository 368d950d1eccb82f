// cmap_convert RECORDING -o CAPTURE: a recording of ROS as a capture.

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "cmap/core/execution.hpp"
#include "cmap/core/progress.hpp"
#include "cmap/io/unpack_recording.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "program.hpp"

namespace {

constexpr const char* kDescription =
    "Unpacks a recording into a capture, which is a folder. A recording is a ROS 1 bag, an MCAP file, or what rosbag2\n"
    "makes; how its sensors sit, and which topics are read, says --config. --topics lists what there is.";

constexpr const char* kExample =
    "Example:\n"
    "  cmap_convert drive.mcap --topics\n"
    "  cmap_convert drive.mcap -o capture --config rig.json --start 1 --duration 60\n"
    "\n"
    "Exit codes: 0 done; 2 wrong usage, or the folder exists or cannot be written; 3 a recording or configuration is\n"
    "missing or malformed; 4 a compression or container that this build cannot read; 70 internal error.";

struct Arguments {
  std::string input, output, config;
  bool lists_topics = false;
  double start_s = 0.0;
  std::optional<double> duration_s;
  std::vector<std::string> topics;
  cmap::CommonArguments common;
};

void add_options(cmap::CommandLine& line, Arguments& a) {
  constexpr double kLongest_s = 1e9;
  line.add("RECORDING", a.input, "PATH", "a bag, an MCAP file, or a folder of rosbag2").required().not_empty();
  line.add("-o,--output", a.output, "DIR", "folder to make").not_empty();
  line.add("--config", a.config, "FILE", "calibration and topics; configs/recordings/ has those of public data sets")
      .not_empty();
  line.add("--topic", a.topics, "ROLE=NAME", "lidar, imu, image or odometry; before the configuration; may be repeated")
      .one_at_a_time()
      .not_empty();
  line.add("--start", a.start_s, "S", "leave out the first seconds [0]").between(0.0, kLongest_s);
  line.add("--duration", a.duration_s, "S", "and all after so many more").between(0.0, kLongest_s);
  line.add_flag("--topics", a.lists_topics, "list the recording's topics, and nothing else");
  cmap::add_common_options(line, a.common, "no progress");
}

cmap::ExitCode list_topics(const std::string& input) {
  std::string text;
  for (const cmap::RecordingTopic& topic : cmap::recording_topics(input)) {
    const std::string_view role = topic.role ? cmap::name_of(*topic.role, cmap::recording_role_names()) : "-";
    text += fmt::format("{:<9} {:>9}  {}  {} ({})\n", role, topic.n_messages, topic.name, topic.type, topic.encoding);
  }
  cmap::print(text);
  return cmap::ExitCode::kDone;
}

void set_topic(cmap::RecordingOptions& options, const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  for (const auto& [role, name] : cmap::recording_role_names()) {
    if (equals == std::string::npos || assignment.substr(0, equals) != name || equals + 1 == assignment.size())
      continue;
    options.source(role).topic = assignment.substr(equals + 1);
    options.source(role).want = cmap::Want::kYes;
    return;
  }
  throw cmap::UsageError(
      fmt::format("--topic: {} is none of lidar=NAME, imu=NAME, image=NAME, odometry=NAME", assignment));
}

cmap::ExitCode run(const Arguments& a) {
  if (a.lists_topics) return list_topics(a.input);
  if (a.output.empty()) throw cmap::UsageError("--output is required (or --topics)");
  if (a.config.empty()) throw cmap::UsageError("--config is required: a capture has a calibration");
  cmap::RecordingConfiguration configuration = cmap::read_recording_configuration(a.config);
  for (const std::string& assignment : a.topics) set_topic(configuration.options, assignment);
  cmap::ProgressBar bar(!a.common.quiet);
  const cmap::ExecutionScope scope(
      {.threads = a.common.threads, .progress = [&](std::string_view stage, double done) { bar.update(stage, done); }});
  const cmap::UnpackedRecording found =
      cmap::unpack_recording(a.input, configuration, a.output, {a.start_s, a.duration_s});
  cmap::print_warnings(found.warnings);
  cmap::print(fmt::format("{} scans, {} images, {} IMU samples, {} poses\n", found.scans, found.images,
                          found.imu_samples, found.poses));
  return cmap::ExitCode::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  cmap::CommandLine line("cmap_convert", kDescription, kExample);
  Arguments arguments;
  add_options(line, arguments);
  return cmap::run_program(line, argc, argv, [&] { return run(arguments); });
}
