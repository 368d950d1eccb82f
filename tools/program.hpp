#pragma once

// What all programs share: common options and how they end.

#include <cstddef>
#include <functional>
#include <string>

#include "cmap/core/error.hpp"
#include "command_line.hpp"

namespace cmap {

struct CommonArguments {
  int threads = 0;  ///< 0: all
  bool quiet = false;
};

void add_common_options(CommandLine& line, CommonArguments& arguments, const char* what_quiet_leaves_out);

/// To standard output; throws OutputError where that fails, as on a full disk. Whoever closes a pipe has read enough.
void print(const std::string& text);

/// Characters of a line of the terminal that standard output is: as COLUMNS says, else as the terminal does. 0 of a
/// pipe or a file.
std::size_t terminal_width();

/// What the help of programs says that read and write single files.
inline constexpr const char* kDash = "\nIn place of a file, - is standard input or standard output.";

/// Parses the command line, calls run(), and turns what it throws into a message on stderr and an exit code.
int run_program(CommandLine& line, int argc, char** argv, const std::function<ExitCode()>& run);

}  // namespace cmap
