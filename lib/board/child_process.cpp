#include "child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
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
#include "cmap/core/execution.hpp"

namespace cmap {
namespace {

/// How the child ends.
enum ChildCode { kDone = 0, kFailed = 1, kWrongUsage = 2, kCannotWrite = 3, kStopped = 4 };

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
  } catch (const OutputError& error) {
    end_child(pipe, kCannotWrite, error.what());
  } catch (const Interrupted&) {
    end_child(pipe, kStopped, "");
  } catch (const std::bad_alloc&) {
    end_child(pipe, kFailed, "not enough memory");
  } catch (const std::exception& error) {
    end_child(pipe, kFailed, error.what());
  }
  end_child(pipe, kDone, "");
}

/// Waits for something to read, and asks meanwhile whether to stop.
void wait_for(int pipe) {
  constexpr int kAskEvery_ms = 100;
  ::pollfd waited{pipe, POLLIN, 0};
  for (int n = 0; n == 0 || (n < 0 && errno == EINTR); n = ::poll(&waited, 1, kAskEvery_ms)) throw_if_stopped();
}

std::string read_to_end(int pipe) {
  std::string text;
  std::array<char, 4096> block;
  for (;;) {
    wait_for(pipe);
    const ssize_t n = ::read(pipe, block.data(), block.size());
    if (n > 0) text.append(block.data(), static_cast<std::size_t>(n));
    if (n == 0 || (n < 0 && errno != EINTR)) return text;
  }
}

int status_of(::pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// What the child says, to its end; it is ended where a stop is requested.
std::string words_of(::pid_t child, int pipe) {
  try {
    return read_to_end(pipe);
  } catch (const Interrupted&) {
    ::kill(child, SIGTERM);  // it then removes what it was writing
    ::close(pipe);
    status_of(child);
    throw;
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
  const std::string message = words_of(child, ends[0]);
  ::close(ends[0]);
  const int status = status_of(child);
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const char* guess = signal == SIGKILL ? "; did the system run out of memory?" : "";
    throw WorkFailure(fmt::format("its evaluation was ended by signal {} ({}){}", signal, ::strsignal(signal), guess));
  }
  if (WEXITSTATUS(status) == kWrongUsage) throw UsageError(message);
  if (WEXITSTATUS(status) == kCannotWrite) throw OutputError(message);
  if (WEXITSTATUS(status) == kStopped) throw Interrupted();
  if (WEXITSTATUS(status) != kDone) throw WorkFailure(message);
}

}  // namespace cmap
