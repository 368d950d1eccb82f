#include "program.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "cmap/io/stop_signals.hpp"

namespace cmap {

void add_common_options(CommandLine& line, CommonArguments& arguments, const char* what_quiet_leaves_out) {
  line.add("--threads", arguments.threads, "N", "threads to use [all]").between(1, 4096);
  line.add_flag("--quiet", arguments.quiet, what_quiet_leaves_out);
}

void print(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written && errno != EPIPE) throw OutputError(fmt::format("standard output: {}", std::strerror(errno)));
}

std::size_t terminal_width() {
  if (isatty(STDOUT_FILENO) != 1) return 0;
  if (const char* columns = std::getenv("COLUMNS")) {
    std::size_t width = 0;
    const char* end = columns + std::strlen(columns);
    if (const auto [rest, fault] = std::from_chars(columns, end, width); fault == std::errc() && rest == end)
      return width;
  }
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

int run_program(CommandLine& line, int argc, char** argv, const std::function<ExitCode()>& run) {
  const std::string name = line.name();
  end_on_signals(name.c_str());
  const auto fail = [&](ExitCode code, const std::string& message) {
    const SignalsWait one_line;  // what a signal took away is no error of its own
    fmt::print(stderr, "{}: {}\n", name, message);
    return static_cast<int>(code);
  };
  try {
    if (const std::optional<int> code = line.parse(argc, argv)) return *code;
    return static_cast<int>(run());
  } catch (const Error& error) {
    return fail(error.exit_code(), error.what());
  } catch (const std::filesystem::filesystem_error& error) {  // as of a folder that may not be looked into
    return fail(ExitCode::kInput, error.what());
  } catch (const std::exception& error) {
    return fail(ExitCode::kInternal, fmt::format("internal error: {}", error.what()));
  }
}

}  // namespace cmap
