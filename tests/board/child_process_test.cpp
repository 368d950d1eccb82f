#include "child_process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <stop_token>
#include <thread>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "core/refusal.hpp"

namespace cmap {
namespace child_process_test {

using test::refusal_of;

TEST(RunApart, SaysWhatTheWorkThrows) {
  EXPECT_NO_THROW(run_apart([] {}));
  EXPECT_EQ(refusal_of<UsageError>([] { run_apart([] { throw UsageError("usage"); }); }), "usage");
  EXPECT_EQ(refusal_of<OutputError>([] { run_apart([] { throw OutputError("disk"); }); }), "disk");
  EXPECT_EQ(refusal_of<WorkFailure>([] { run_apart([] { throw InputError("input"); }); }), "input");
}

TEST(RunApart, AStopEndsTheWork) {
  std::stop_source stop;
  const ExecutionScope scope({.stop = stop.get_token()});
  const auto start = std::chrono::steady_clock::now();
  std::jthread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    stop.request_stop();
  });
  EXPECT_THROW(run_apart([] { ::sleep(60); }), Interrupted);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(RunApart, AStopThatTheWorkRequestsEndsTheCaller) {
  std::stop_source stop;
  const ExecutionScope scope({.stop = stop.get_token()});
  EXPECT_THROW(run_apart([&] {
                 stop.request_stop();
                 throw_if_stopped();
               }),
               Interrupted);
}

}  // namespace child_process_test
}  // namespace cmap
