// read_recording FILE: reads every message of a recording, points unpacked and checksums compared, and says what it
// cost.

#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "cmap/io/recording.hpp"

namespace {

/// Most memory held at once; getrusage would count that of whoever started the program.
double peak_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: read_recording FILE\n");
    return 2;
  }
  const auto start = std::chrono::steady_clock::now();
  cmap::Recording recording(argv[1]);
  std::size_t messages = 0, points = 0;
  double sum = 0.0;
  while (const auto message = recording.next()) {
    ++messages;
    if (const auto* scan = std::get_if<cmap::LidarScan>(&*message)) {
      points += scan->positions.size();
      if (!scan->positions.empty())
        sum += scan->positions.back().x() + (scan->time_s.empty() ? 0.0F : scan->time_s.back());
    }
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  std::printf(
      "{\"messages\": %zu, \"points\": %zu, \"sum\": %.9g, \"cpu_s\": %.4f, \"wall_s\": %.4f, \"peak_mb\": %.1f}\n",
      messages, points, sum, seconds(usage.ru_utime) + seconds(usage.ru_stime), wall.count(), peak_mb());
  return 0;
}
