#include "cmap/core/execution.hpp"

#include <chrono>
#include <future>
#include <mutex>
#include <set>
#include <thread>

#include "cmap/core/parallel.hpp"
#include "cmap/eval/map_evaluation.hpp"
#include "cmap/eval/protocol.hpp"
#include "eval/eval_testing.hpp"

namespace cmap {
namespace execution_test {

using test::fields_of;
using test::options_for;
using test::painted_sheet;
using ::testing::Each;
using ::testing::ElementsAreArray;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

struct Told {
  std::vector<std::string> stages;
  std::vector<int> threads;
  Execution execution(int n) {
    return {.threads = n, .progress = [this](std::string_view stage, double) {
              stages.emplace_back(stage);
              threads.push_back(thread_count());
            }};
  }
};

std::vector<std::string> stages_of(const Evaluation& evaluation) {
  std::vector<std::string> stages;
  for (const auto& [stage, seconds] : evaluation.stage_seconds) stages.push_back(stage);
  return stages;
}

TEST(Execution, TwoEvaluationsAtATimeDoNotDisturbEachOther) {
  const EvaluationOptions geometry = options_for({"geometry"}), all = options_for({"all"});
  const PointCloud a = painted_sheet(20'000, 1), b = painted_sheet(15'000, 2);
  const Json geometry_alone = fields_of(evaluate(a, b, geometry).metrics),
             all_alone = fields_of(evaluate(b, a, all).metrics);
  for (int round = 0; round < 3; ++round) {
    Told of_one, of_two;
    std::future<EvaluatedPair> other = std::async(
        std::launch::async, [&] { return evaluate(a, b, geometry, Eigen::Matrix4d::Identity(), of_one.execution(1)); });
    const Evaluation mine = evaluate(b, a, all, Eigen::Matrix4d::Identity(), of_two.execution(2));
    const Evaluation found = other.get();
    EXPECT_EQ(fields_of(found.metrics), geometry_alone);
    EXPECT_EQ(fields_of(mine.metrics), all_alone);
    EXPECT_THAT(of_one.stages, ElementsAreArray(stages_of(found)));
    EXPECT_THAT(of_two.stages, ElementsAreArray(stages_of(mine)));
    EXPECT_THAT(of_one.threads, Each(1));
    EXPECT_THAT(of_two.threads, Each(std::min(2, thread_count())));
  }
}

TEST(Execution, TheProtocolTellsItsOwnStagesAndThoseOfTheEvaluation) {
  EvaluationOptions options = options_for({"chamfer"});
  options.align = test::aligner("icp");
  options.allow_unconverged = true;  // points anywhere in a box have no surface to judge by
  const PointCloud map = test::uniform_cloud(2000, 1);
  Told told;
  const Evaluation found = evaluate_by_protocol(map, map, options, {}, told.execution(1));
  EXPECT_THAT(told.stages, ElementsAreArray(stages_of(found)));
  EXPECT_THAT(told.threads, Each(1));
}

/// Long for one thread: seconds, most of them within the stages of fields and sums.
EvaluationOptions slow_options() {
  EvaluationOptions options = options_for({"all"});
  options.mme_radius_m = 1.0;
  return options;
}

TEST(Execution, AStopFromAnotherThreadEndsAnEvaluationWithinASecond) {
  const PointCloud map = painted_sheet(300'000, 1);
  std::stop_source stop;
  std::promise<void> begun;
  std::future<Clock::time_point> ended = std::async(std::launch::async, [&] {
    const auto tell = [&, said = false](std::string_view stage, double) mutable {
      if (stage == "nearest neighbors" && !std::exchange(said, true)) begun.set_value();
    };
    EXPECT_THROW(evaluate(map, map, slow_options(), Eigen::Matrix4d::Identity(),
                          {.threads = 2, .stop = stop.get_token(), .progress = tell}),
                 Interrupted);
    return Clock::now();
  });
  begun.get_future().wait();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const Clock::time_point requested = Clock::now();
  stop.request_stop();
  EXPECT_LT(ended.get() - requested, std::chrono::seconds(1));
  EXPECT_EQ(evaluate(map, map, options_for({"chamfer"})).metrics.at("chamfer").value, 0.0) << "the next call works";
}

TEST(Execution, AStopFromTheSinkEndsAnEvaluationBeforeTheStage) {
  const PointCloud map = painted_sheet(2000, 1);
  for (const char* last : {"prepare", "index", "nearest neighbors", "sums"}) {
    std::stop_source stop;
    std::vector<std::string> told;
    const auto tell = [&](std::string_view stage, double) {
      told.emplace_back(stage);
      if (stage == last) stop.request_stop();
    };
    EXPECT_THROW(evaluate_by_protocol(map, map, options_for({"all"}), {}, {.stop = stop.get_token(), .progress = tell}),
                 Interrupted);
    EXPECT_EQ(told.back(), last);
  }
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(evaluate_map(map, {}, {.stop = stop.get_token()}), Interrupted);
  EXPECT_NO_THROW(evaluate_map(map, {}));
}

}  // namespace execution_test
}  // namespace cmap
