#include "cmap/io/stop_signals.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <string>
#include <string_view>

// A handler may call few functions: no allocation, no lock, no opendir.

namespace cmap {
namespace {

struct EndingSignal {
  int number;
  const char* what;
  std::string line = {};  ///< for stderr
};
using EndingSignals = std::array<EndingSignal, 3>;
/// Never destroyed: signals come to the very end.
EndingSignals& ending_signals =
    *new EndingSignals{{{SIGINT, "interrupted"}, {SIGTERM, "terminated"}, {SIGHUP, "its terminal was closed"}}};

/// What goes when the program is stopped: a path, or a child.
struct Taken {
  std::string path;
  ::pid_t child = 0;
  ::pid_t owner = ::getpid();  ///< what a forked process inherits is not its own
};

/// Whoever takes an entry out of its slot owns it. Files without a name need none; when all are taken, a name stays.
std::array<std::atomic<Taken*>, 1024> slots;
static_assert(std::atomic<Taken*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);
std::mutex slots_mutex;  ///< of those who look into entries; the handler only takes them

/// How many SignalsWait live, and above these bits the signal that waits; or kEnding.
std::atomic<int> state{0};
constexpr int kEnding = -1, kWaitBits = 16, kWaits = (1 << kWaitBits) - 1;
::pid_t program_process = 0;

void remove_all(int parent, const char* name);

/// Removes what a folder holds. The kernel's own listing, as opendir() allocates.
void remove_entries(int folder) {
  alignas(dirent64) char block[4096];
  for (;;) {
    const long filled = ::syscall(SYS_getdents64, folder, block, sizeof block);
    if (filled <= 0) return;
    for (long at = 0; at < filled;) {
      const auto* entry = reinterpret_cast<const dirent64*>(block + at);
      const std::string_view name(entry->d_name);
      if (name != "." && name != "..") remove_all(folder, entry->d_name);
      at += entry->d_reclen;
    }
  }
}

void remove_all(int parent, const char* name) {
  if (::unlinkat(parent, name, 0) == 0) return;
  const int folder = ::openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) return;
  constexpr int kAttempts = 100;  // other threads may still write there
  for (int i = 0; i < kAttempts; ++i) {
    remove_entries(folder);
    if (::unlinkat(parent, name, AT_REMOVEDIR) == 0 || (errno != ENOTEMPTY && errno != EEXIST)) break;
    ::lseek(folder, 0, SEEK_SET);
  }
  ::close(folder);
}

/// Ends what this process has registered: children first, as they may be writing.
void end_taken() {
  std::array<const Taken*, std::tuple_size_v<decltype(slots)>> taken{};
  for (std::size_t i = 0; i < slots.size(); ++i) {
    taken[i] = slots[i].exchange(nullptr);
    if (taken[i] != nullptr && taken[i]->owner != ::getpid()) taken[i] = nullptr;
  }
  for (const Taken* entry : taken) {
    if (entry != nullptr && entry->child != 0) ::kill(entry->child, SIGKILL);
  }
  for (const Taken* entry : taken) {
    if (entry != nullptr && entry->child == 0) remove_all(AT_FDCWD, entry->path.c_str());
  }
}

/// Ends a forked process as the signal would have: its parent sees that, and speaks.
void end_unhandled(int signal) {
  std::signal(signal, SIG_DFL);
  sigset_t only;
  ::sigemptyset(&only);
  ::sigaddset(&only, signal);
  ::pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  ::kill(::getpid(), signal);
}

[[noreturn]] void end_by(int signal) {
  end_taken();
  if (::getpid() != program_process) end_unhandled(signal);
  for (const EndingSignal& ending : ending_signals) {
    if (ending.number != signal) continue;
    (void)!::write(STDERR_FILENO, ending.line.data(), ending.line.size());
  }
  ::_exit(128 + signal);
}

extern "C" void on_ending_signal(int signal) {
  const int error = errno;
  for (int seen = state.load(); seen != kEnding;) {
    const bool waits = (seen & kWaits) != 0;
    if (!state.compare_exchange_weak(seen, waits ? (seen & kWaits) | signal << kWaitBits : kEnding)) continue;
    if (!waits) end_by(signal);
    break;
  }
  errno = error;
}

void put(Taken* taken) {
  for (std::atomic<Taken*>& slot : slots) {
    Taken* empty = nullptr;
    if (slot.compare_exchange_strong(empty, taken)) return;
  }
  delete taken;
}

template <class Matches>
void take_out(Matches&& matches) {
  const std::lock_guard lock(slots_mutex);
  for (std::atomic<Taken*>& slot : slots) {
    Taken* taken = slot.load();
    if (taken == nullptr || !matches(*taken)) continue;
    if (slot.compare_exchange_strong(taken, nullptr)) delete taken;
    return;
  }
}

}  // namespace

void end_on_signals(const char* program) {
  program_process = ::getpid();
  const char* over_progress = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
  for (EndingSignal& ending : ending_signals) {
    ending.line = fmt::format("{}{}: {}\n", over_progress, program, ending.what);
    struct sigaction before {
    }, action{};
    ::sigaction(ending.number, nullptr, &before);
    if (ending.number == SIGHUP && before.sa_handler == SIG_IGN) continue;
    action.sa_handler = on_ending_signal;
    action.sa_flags = SA_RESTART;
    ::sigfillset(&action.sa_mask);
    ::sigaction(ending.number, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void remove_when_stopped(const std::filesystem::path& temporary) {
  std::error_code ignored;  // the working directory may change
  put(new Taken{std::filesystem::absolute(temporary, ignored).string()});
}

void keep_when_stopped(const std::filesystem::path& temporary) {
  std::error_code ignored;
  const std::string path = std::filesystem::absolute(temporary, ignored).string();
  take_out([&](const Taken& taken) { return taken.child == 0 && taken.path == path; });
}

void end_when_stopped(::pid_t child) { put(new Taken{{}, child}); }

void forget_child(::pid_t child) {
  take_out([&](const Taken& taken) { return taken.child == child; });
}

SignalsWait::SignalsWait() {
  for (int seen = state.load();;) {
    if (seen == kEnding) {
      ::pause();
      seen = state.load();
    } else if (state.compare_exchange_weak(seen, seen + 1)) {
      return;
    }
  }
}

SignalsWait::~SignalsWait() {
  for (int seen = state.load();;) {
    const int left = seen - 1;
    const bool ends = (left & kWaits) == 0 && left != 0;
    if (!state.compare_exchange_weak(seen, ends ? kEnding : left)) continue;
    if (ends) end_by(left >> kWaitBits);
    return;
  }
}

}  // namespace cmap
