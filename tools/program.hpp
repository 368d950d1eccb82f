#pragma once

// What all programs share: common options and how they end.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "cmap/core/error.hpp"
#include "cmap/core/version.hpp"

namespace cmap {

struct CommonArguments {
  int threads = 0;  ///< 0: all
  bool quiet = false;
};

inline void add_common_options(CLI::App& app, CommonArguments& arguments, const char* what_quiet_leaves_out) {
  app.add_option("--threads", arguments.threads, "threads to use [all]")
      ->type_name("N")
      ->check(CLI::Range(1, 4096).description(""));
  app.add_flag("--quiet", arguments.quiet, what_quiet_leaves_out);
}

/// An unset variable of a script must not silently mean the default.
inline void refuse_empty(CLI::App& app, std::initializer_list<const char*> options) {
  const CLI::Validator not_empty([](std::string& text) { return text.empty() ? std::string("is empty") : ""; }, "");
  for (const char* name : options) app.get_option(name)->check(not_empty);
}

/// To standard output; throws UsageError where that fails, as on a full disk.
inline void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw UsageError(fmt::format("standard output: {}", std::strerror(errno)));
  }
}

/// Parses the command line, calls run(), and turns what it throws into a message on stderr and an exit code.
template <class Run>
int run_program(CLI::App& app, int argc, char** argv, Run&& run) {
  const std::string name = app.get_name();
  app.set_version_flag("--version", fmt::format("{} {}", name, kVersion));
  try {
    app.parse(argc, argv);
    return static_cast<int>(run());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    fmt::print(stderr, "{}: {}\nRun {} --help for usage.\n", name, error.what(), name);
    return static_cast<int>(ExitCode::kUsage);
  } catch (const Error& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return static_cast<int>(error.exit_code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: internal error: {}\n", name, error.what());
    return static_cast<int>(ExitCode::kInternal);
  }
}

}  // namespace cmap
