#pragma once

// What all programs share: common options and how they end.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "cmap/core/error.hpp"
#include "cmap/core/spelling.hpp"
#include "cmap/core/version.hpp"
#include "cmap/io/stop_signals.hpp"

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

/// The words that an option takes.
inline CLI::Validator one_of(std::vector<std::string> words) {
  const auto reason = [words = std::move(words)](std::string& text) {
    if (std::ranges::count(words, text) > 0) return std::string();
    return fmt::format("\"{}\" {}", text, is_none_of(text, words));
  };
  return {reason, ""};
}

/// To standard output; throws OutputError where that fails, as on a full disk. Whoever closes a pipe has read enough.
inline void print(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written && errno != EPIPE) throw OutputError(fmt::format("standard output: {}", std::strerror(errno)));
}

/// Names the arguments that no option takes, in their order, and the options that are spelled nearly like them.
inline std::string about_stray_arguments(const CLI::App& app) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  const std::vector<std::string> stray = app.remaining();
  std::string text = fmt::format("not expected: {}", fmt::join(stray, " "));
  for (const std::string& argument : stray) {
    if (argument.starts_with("--")) text += did_you_mean(argument.substr(0, argument.find('=')), known);
  }
  return text;
}

/// What every program's help ends with.
inline constexpr const char* kStopCodes = "\n130 interrupted, 143 terminated: nothing half-written is left.";
inline constexpr const char* kDash = "\nIn place of a file, - is standard input or standard output.";

/// Parses the command line, calls run(), and turns what it throws into a message on stderr and an exit code.
template <class Run>
int run_program(CLI::App& app, int argc, char** argv, Run&& run) {
  const std::string name = app.get_name();
  end_on_signals(name.c_str());
  app.footer(app.get_footer() + kStopCodes);
  app.set_version_flag("--version", fmt::format("{} {}", name, kVersion));
  const auto fail = [&](ExitCode code, const std::string& message) {
    const SignalsWait one_line;  // what a signal took away is no error of its own
    fmt::print(stderr, "{}: {}\n", name, message);
    return static_cast<int>(code);
  };
  const auto usage = [&](const std::string& reason) {
    return fail(ExitCode::kUsage, fmt::format("{}\nRun {} --help for usage.", reason, name));
  };
  try {
    app.parse(argc, argv);
    return static_cast<int>(run());
  } catch (const CLI::ExtrasError&) {
    return usage(about_stray_arguments(app));
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? app.exit(error) : usage(error.what());
  } catch (const Error& error) {
    return fail(error.exit_code(), error.what());
  } catch (const std::filesystem::filesystem_error& error) {  // as of a folder that may not be looked into
    return fail(ExitCode::kInput, error.what());
  } catch (const std::exception& error) {
    return fail(ExitCode::kInternal, fmt::format("internal error: {}", error.what()));
  }
}

}  // namespace cmap
