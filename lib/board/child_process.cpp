#include "child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>

#include "cmap/core/error.hpp"

namespace cmap {
namespace {

/// How the child ends.
enum ChildCode { kDone = 0, kFailed = 1, kWrongUsage = 2 };

[[noreturn]] void end_child(int pipe, ChildCode code, const std::string& message) {
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t n = ::write(pipe, message.data() + sent, message.size() - sent);
    if (n < 0 && errno != EINTR) break;
    if (n > 0) sent += static_cast<std::size_t>(n);
  }
  ::_exit(code);  // buffers and objects are the parent's
}

[[noreturn]] void run_child(int pipe, ::pid_t parent, const std::function<void()>& work) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // it then removes what it was writing
  if (::getppid() != parent) ::_exit(kFailed);
  try {
    work();
  } catch (const UsageError& error) {
    end_child(pipe, kWrongUsage, error.what());
  } catch (const std::bad_alloc&) {
    end_child(pipe, kFailed, "not enough memory");
  } catch (const std::exception& error) {
    end_child(pipe, kFailed, error.what());
  }
  end_child(pipe, kDone, "");
}

std::string read_to_end(int pipe) {
  std::string text;
  std::array<char, 4096> block;
  for (;;) {
    const ssize_t n = ::read(pipe, block.data(), block.size());
    if (n > 0) text.append(block.data(), static_cast<std::size_t>(n));
    if (n == 0 || (n < 0 && errno != EINTR)) return text;
  }
}

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
}

}  // namespace

void run_apart(const std::function<void()>& work) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail("pipe");
  std::fflush(nullptr);
  const ::pid_t parent = ::getpid(), child = ::fork();
  if (child < 0) fail("fork");
  if (child == 0) run_child(ends[1], parent, work);
  ::close(ends[1]);
  const std::string message = read_to_end(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const char* guess = signal == SIGKILL ? "; did the system run out of memory?" : "";
    throw WorkFailure(fmt::format("its evaluation was ended by signal {} ({}){}", signal, ::strsignal(signal), guess));
  }
  if (WEXITSTATUS(status) == kWrongUsage) throw UsageError(message);
  if (WEXITSTATUS(status) != kDone) throw WorkFailure(message);
}

}  // namespace cmap
