#include "cmap/core/execution.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>

#include "cmap/core/error.hpp"
#include "cmap/core/parallel.hpp"

namespace cmap {
namespace execution_test {

using ::testing::ElementsAre;
constexpr int kThreads[] = {1, 2, 0};  // 0: all the machine has

TEST(ExecutionScope, NestsAndRestores) {
  const int all = thread_count();
  const int two = std::min(2, all);
  {
    const ExecutionScope outer({.threads = 2});
    EXPECT_EQ(thread_count(), two);
    {
      const ExecutionScope inner({.threads = 1});
      EXPECT_EQ(thread_count(), 1);
      const ExecutionScope innermost({});
      EXPECT_EQ(thread_count(), 1) << "as many as the caller's";
    }
    EXPECT_EQ(thread_count(), two);
    try {
      const ExecutionScope thrown_out_of({.threads = 1});
      throw InputError("");
    } catch (const InputError&) {
    }
    EXPECT_EQ(thread_count(), two);
  }
  EXPECT_EQ(thread_count(), all);
}

TEST(ExecutionScope, IsThatOfTheTasksToo) {
  for (int threads : kThreads) {
    const ExecutionScope scope({.threads = threads});
    const int n = thread_count();
    std::atomic<int> others = 0;
    const auto look = [&](std::size_t, std::size_t) {
      if (thread_count() != n) ++others;
      {
        const ExecutionScope inner({.threads = 1});
        parallel_chunks(3, 1, [&](std::size_t, std::size_t) { others += thread_count() != 1 ? 1 : 0; });
      }
      parallel_chunks(3, 1, [&](std::size_t, std::size_t) { others += thread_count() != n ? 1 : 0; });
    };
    parallel_chunks(200, 1, look);
    EXPECT_EQ(others, 0) << threads;
  }
}

TEST(ExecutionScope, LoopsTakeNoMoreThreadsThanItSays) {
  const ExecutionScope scope({.threads = 2});
  std::mutex mutex;
  std::set<std::thread::id> seen;
  parallel_chunks(200, 1, [&](std::size_t, std::size_t) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    const std::lock_guard lock(mutex);
    seen.insert(std::this_thread::get_id());
  });
  EXPECT_LE(seen.size(), 2u);
}

TEST(ExecutionScope, TwoThreadsHaveTheirOwn) {
  const int two = std::min(2, thread_count());
  std::barrier both(2);
  int seen[2] = {};
  std::vector<std::string> stages[2];
  const auto run = [&](int which, int threads) {
    const ExecutionScope scope({.threads = threads, .progress = [&, which](std::string_view stage, double) {
                                  stages[which].emplace_back(stage);
                                }});
    both.arrive_and_wait();
    seen[which] = thread_count();
    report_progress(which == 0 ? "first" : "second", 0.5);
    both.arrive_and_wait();
  };
  std::thread other([&] { run(0, 1); });
  run(1, 2);
  other.join();
  EXPECT_EQ(seen[0], 1);
  EXPECT_EQ(seen[1], two);
  EXPECT_THAT(stages[0], ElementsAre("first"));
  EXPECT_THAT(stages[1], ElementsAre("second"));
}

TEST(Progress, GoesToTheInnermostSinkAlone) {
  std::vector<std::string> outer, inner;
  const auto into = [](std::vector<std::string>& list) {
    return [&list](std::string_view stage, double) { list.emplace_back(stage); };
  };
  EXPECT_NO_THROW(report_progress("nobody listens", 0.0));
  const ExecutionScope around({.progress = into(outer)});
  report_progress("a", 0.0);
  {
    const ExecutionScope silent({});
    report_progress("b", 0.0);
    const ExecutionScope within({.progress = into(inner)});
    report_progress("c", 0.0);
  }
  report_progress("d", 0.0);
  EXPECT_THAT(outer, ElementsAre("a", "d"));
  EXPECT_THAT(inner, ElementsAre("c"));
}

TEST(Stop, EndsLoopsAtTheNextChunk) {
  for (int threads : kThreads) {
    std::stop_source stop;
    const ExecutionScope scope({.threads = threads, .stop = stop.get_token()});
    std::atomic<int> chunks = 0;
    EXPECT_THROW(parallel_chunks(1'000'000, 1,
                                 [&](std::size_t, std::size_t) {
                                   if (++chunks == 100) stop.request_stop();
                                 }),
                 Interrupted);
    EXPECT_LT(chunks, 10'000) << threads;
    EXPECT_THROW(parallel_tasks({[] {}}), Interrupted);
    EXPECT_THROW(throw_if_stopped(), Interrupted);
  }
  EXPECT_NO_THROW(throw_if_stopped());
  EXPECT_NO_THROW(parallel_tasks({[] {}}));
}

TEST(Stop, OfACallEndsThoseInsideIt) {
  std::stop_source stop;
  const ExecutionScope outer({.stop = stop.get_token()});
  const ExecutionScope inner({.threads = 2, .stop = std::stop_source().get_token()});
  std::atomic<int> loops = 0;
  const auto nested = [&] {
    const ExecutionScope innermost({.threads = 1});
    parallel_chunks(1000, 1, [&](std::size_t, std::size_t) {
      if (++loops == 5) stop.request_stop();
    });
  };
  EXPECT_THROW(parallel_tasks({nested, nested, nested}), Interrupted);
  EXPECT_LT(loops, 1000);
}

TEST(Stop, MayBeRequestedByTheSink) {
  std::stop_source stop;
  const ExecutionScope scope({.stop = stop.get_token(), .progress = [&](std::string_view, double done) {
                                if (done > 0.5) stop.request_stop();
                              }});
  EXPECT_NO_THROW(report_progress("stage", 0.1));
  EXPECT_THROW(report_progress("stage", 0.9), Interrupted);
}

TEST(Interrupted, IsAnErrorOfItsOwnExitCode) {
  EXPECT_EQ(Interrupted().exit_code(), ExitCode::kInterrupted);
  EXPECT_EQ(static_cast<int>(ExitCode::kInterrupted), 130);
  EXPECT_EQ(OutputError("").exit_code(), ExitCode::kUsage);
}

}  // namespace execution_test
}  // namespace cmap
