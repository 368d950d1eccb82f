#pragma once

#include <stdexcept>
#include <string>

namespace cmap {

/// Exit codes of every program (REPORT, "Exit codes").
enum class ExitCode : int {
  kDone = 0,
  kRequirementFailed = 1,
  kUsage = 2,
  kInput = 3,
  kUnsupported = 4,
  kInternal = 70,
  kInterrupted = 130,
};

/// Base of every error that cmap throws on purpose. The message names file, place and reason.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode exit_code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// A wrong option, configuration key or value.
struct UsageError : Error {
  explicit UsageError(const std::string& message) : Error(ExitCode::kUsage, message) {}
};

/// An output that cannot be written: a full disk, a folder that is protected or not there, a name that is taken.
struct OutputError : Error {
  explicit OutputError(const std::string& message) : Error(ExitCode::kUsage, message) {}
};

/// An input that is missing, unreadable, malformed, or without a single finite point.
struct InputError : Error {
  explicit InputError(const std::string& message) : Error(ExitCode::kInput, message) {}
};

/// Inputs that do not support what was asked, for example no color for a color metric; or this build does not.
struct UnsupportedError : Error {
  explicit UnsupportedError(const std::string& message) : Error(ExitCode::kUnsupported, message) {}
};

/// The end of a call whose stop was requested (cmap/core/execution.hpp); a program that is stopped by a signal ends
/// without it. Whoever goes on after other errors lets this one pass.
struct Interrupted : Error {
  Interrupted() : Error(ExitCode::kInterrupted, "interrupted") {}
};

}  // namespace cmap
