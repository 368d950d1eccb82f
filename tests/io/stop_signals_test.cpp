#include "cmap/io/stop_signals.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "cmap/io/output_file.hpp"
#include "cmap/io/output_folder.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace stop_signals_test {

namespace fs = std::filesystem;

/// How a process that did this ended, and what it said on stderr.
struct Ending {
  int status = 0;
  std::string said;

  int exit_code() const { return WIFEXITED(status) ? WEXITSTATUS(status) : -1; }
};

Ending ending_of(const std::function<void()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const ::pid_t process = ::fork();
  if (process == 0) {
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    end_on_signals("program");
    work();
    ::_exit(0);
  }
  ::close(ends[1]);
  Ending ending;
  char letter = 0;
  while (::read(ends[0], &letter, 1) == 1) ending.said += letter;  // until all that hold the pipe have ended
  ::close(ends[0]);
  ::waitpid(process, &ending.status, 0);
  return ending;
}

TEST(StopSignals, EndWithTheirCodeAndALine) {
  const Ending interrupted = ending_of([] { std::raise(SIGINT); });
  EXPECT_EQ(interrupted.exit_code(), 130);
  EXPECT_EQ(interrupted.said, "program: interrupted\n");
  const Ending terminated = ending_of([] { std::raise(SIGTERM); });
  EXPECT_EQ(terminated.exit_code(), 143);
  EXPECT_EQ(terminated.said, "program: terminated\n");
  EXPECT_EQ(ending_of([] { std::raise(SIGHUP); }).exit_code(), 129);
}

TEST(StopSignals, OfNohupAreIgnored) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  EXPECT_EQ(ending_of([] { std::raise(SIGHUP); }).exit_code(), 0);
  std::signal(SIGHUP, before);
}

TEST(StopSignals, TakeAwayWhatIsRegistered) {
  const TempFolder folder;
  const fs::path file = folder.write("half", "x"), complete = folder.write("complete", "x");
  fs::create_directories(folder / "frames/deeper/still");
  for (int i = 0; i < 300; ++i) folder.write("frames/" + std::to_string(i), "x");  // more than one listing holds
  folder.write("frames/deeper/still/file", "x");
  fs::create_symlink(folder / "complete", folder / "frames/link");
  const Ending ending = ending_of([&] {
    remove_when_stopped(file);
    remove_when_stopped(complete);
    remove_when_stopped(folder / "frames");
    remove_when_stopped(folder / "never made");
    keep_when_stopped(complete);
    std::raise(SIGTERM);
  });
  EXPECT_EQ(ending.exit_code(), 143);
  EXPECT_FALSE(fs::exists(file));
  EXPECT_FALSE(fs::exists(folder / "frames"));
  EXPECT_TRUE(fs::exists(complete)) << "neither by its name nor through a link";
}

TEST(StopSignals, TakeAwayWhatIsNamedFromTheWorkingFolder) {
  const TempFolder folder;
  folder.write("half", "x");
  const Ending ending = ending_of([&] {
    fs::current_path(folder.path());
    remove_when_stopped("half");
    fs::current_path("/");
    std::raise(SIGTERM);
  });
  EXPECT_EQ(ending.exit_code(), 143);
  EXPECT_FALSE(fs::exists(folder / "half"));
}

TEST(StopSignals, EndTheChildrenThatAreRegistered) {
  const Ending ending = ending_of([] {
    const ::pid_t child = ::fork();
    if (child == 0) {
      std::signal(SIGTERM, SIG_IGN);
      for (;;) ::pause();  // holds the pipe: the test would never end
    }
    end_when_stopped(child);
    std::raise(SIGTERM);
  });
  EXPECT_EQ(ending.exit_code(), 143);
}

TEST(StopSignals, LeaveAChildThatHasEndedAlone) {
  const TempFolder folder;
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const Ending ending = ending_of([&] {
    const ::pid_t child = ::fork();
    if (child == 0) {
      ::close(STDERR_FILENO);
      char letter = 0;
      ::close(ends[1]);
      (void)!::read(ends[0], &letter, 1);  // until the test has seen the other end
      std::ofstream(folder / "alive");
      ::_exit(0);
    }
    end_when_stopped(child);
    forget_child(child);
    std::raise(SIGTERM);
  });
  EXPECT_EQ(ending.exit_code(), 143);
  ::close(ends[0]);
  ::close(ends[1]);
  for (int i = 0; i < 1000 && !fs::exists(folder / "alive"); ++i) ::usleep(10'000);
  EXPECT_TRUE(fs::exists(folder / "alive"));
}

TEST(StopSignals, WaitForWhatMustBeWhole) {
  const TempFolder folder;
  const Ending ending = ending_of([&] {
    {
      const SignalsWait outer;
      const SignalsWait inner;
      std::raise(SIGTERM);
      folder.write("first", "x");
      folder.write("second", "x");
    }
    folder.write("after", "x");
  });
  EXPECT_EQ(ending.exit_code(), 143);
  EXPECT_TRUE(fs::exists(folder / "second"));
  EXPECT_FALSE(fs::exists(folder / "after"));
}

TEST(StopSignals, WithoutOneNothingHappensAfterWaiting) {
  EXPECT_EQ(ending_of([] { const SignalsWait waits; }).exit_code(), 0);
}

TEST(StopSignals, EndAForkedProcessAsTheyWouldHave) {
  const TempFolder folder;
  const fs::path of_parent = folder.write("of the parent", "x"), of_child = folder.write("of the child", "x");
  int child_status = 0;
  const Ending ending = ending_of([&] {
    remove_when_stopped(of_parent);
    const ::pid_t child = ::fork();
    if (child == 0) {
      remove_when_stopped(of_child);
      std::raise(SIGTERM);
    }
    ::waitpid(child, &child_status, 0);
    ::_exit(WIFSIGNALED(child_status) && WTERMSIG(child_status) == SIGTERM ? 0 : 1);
  });
  EXPECT_EQ(ending.exit_code(), 0);
  EXPECT_EQ(ending.said, "") << "its parent speaks";
  EXPECT_FALSE(fs::exists(of_child));
  EXPECT_TRUE(fs::exists(of_parent));
}

TEST(StopSignals, LeaveNothingOfAnUnfinishedFolder) {
  const TempFolder folder;
  const Ending ending = ending_of([&] {
    const OutputFolder output(folder / "frames");
    std::ofstream(output.subfolder("deeper") / "frame") << "half";
    std::raise(SIGTERM);
  });
  EXPECT_EQ(ending.exit_code(), 143);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(StopSignals, LeaveAFinishedFolder) {
  const TempFolder folder;
  const Ending ending = ending_of([&] {
    OutputFolder output(folder / "frames");
    output.commit();
    std::raise(SIGTERM);
  });
  EXPECT_EQ(ending.exit_code(), 143);
  EXPECT_TRUE(fs::is_directory(folder / "frames"));
}

TEST(StopSignals, LeaveNothingOfAnOutputFile) {
  const TempFolder folder;
  folder.write("old", "old");
  for (const int signal : {SIGTERM, SIGKILL}) {
    const Ending ending = ending_of([&] {
      OutputFile fresh(folder / "new"), replaced(folder / "old");
      fresh.write("half");
      replaced.write("half");
      replaced.finish();
      std::raise(signal);
    });
    EXPECT_NE(ending.status, 0);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
    EXPECT_EQ(read_bytes(folder / "old"), "old");
  }
}

}  // namespace stop_signals_test
}  // namespace cmap::testing
