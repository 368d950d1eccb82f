#pragma once

#include <sys/types.h>

#include <filesystem>

namespace cmap {

/// From here on SIGINT, SIGTERM and SIGHUP (unless the caller ignores that one, as nohup does) end the program with
/// exit code 128 + signal and one line on stderr, and take with them what is registered below. A closed pipe and a file
/// above the shell's limit become errors of writing. Call once, before threads are started.
void end_on_signals(const char* program);

/// A file, or a folder with all that is in it, that does not outlive the program when a signal ends it.
void remove_when_stopped(const std::filesystem::path& temporary);
/// It is gone, or complete.
void keep_when_stopped(const std::filesystem::path& temporary);

/// A child that works for this program alone; ended with it.
void end_when_stopped(::pid_t child);
/// It has ended.
void forget_child(::pid_t child);

/// While one lives, signals wait: what must happen as a whole does. Where a signal ends the program already, it never
/// comes to be.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
};

}  // namespace cmap
