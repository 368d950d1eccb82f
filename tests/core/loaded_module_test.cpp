#include "cmap/core/loaded_module.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stop_token>

#include "cmap/core/error.hpp"
#include "cmap/core/execution.hpp"
#include "cmap/core/parallel.hpp"
#include "core/modules/counter_module.hpp"

namespace cmap {
namespace loaded_module_test {

using ::testing::AllOf;
using testing::CounterTable;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The same module, of which the program expects another table.
struct NewerTable : CounterTable {
  static constexpr int kTable = 8;
};

template <class Table>
std::string refusal(const std::string& file) {
  try {
    load_module<Table>(file, "this build cannot count");
  } catch (const UnsupportedError& error) {
    return error.what();
  }
  return "";
}

const CounterTable& counter() { return load_module<CounterTable>(CMAP_TEST_COUNTER_MODULE, ""); }

TEST(LoadedModule, GivesItsTable) { EXPECT_EQ(counter().count(100), 100); }

TEST(LoadedModule, RunsAsTheProgramDoes) {
  const int all = thread_count();
  EXPECT_EQ(counter().threads(), all);
  EXPECT_EQ(counter().simd(), simd_level());
  {
    const ExecutionScope one({.threads = 1});
    EXPECT_EQ(counter().threads(), 1);
  }
  EXPECT_EQ(counter().threads(), all);
  std::stop_source stop;
  const ExecutionScope stoppable({.stop = stop.get_token()});
  EXPECT_EQ(counter().count(10), 10);
  stop.request_stop();
  EXPECT_THROW(counter().count(10), Interrupted);
}

TEST(LoadedModule, OfAnotherVersionIsRefused) {
  EXPECT_THAT(refusal<CounterTable>(CMAP_TEST_OTHER_MODULE),
              AllOf(StartsWith(CMAP_TEST_OTHER_MODULE ": is of cmap 0.0.1, counter table 7, needed is "),
                    HasSubstr(module_build("counter", 7)), EndsWith("install programs and modules of one build")));
}

TEST(LoadedModule, OfAnotherTableIsRefused) {
  EXPECT_THAT(refusal<NewerTable>(CMAP_TEST_COUNTER_MODULE),
              AllOf(HasSubstr("is of " + module_build("counter", 7)), HasSubstr(module_build("counter", 8))));
}

TEST(LoadedModule, ALibraryThatIsNoneIsRefused) {
  EXPECT_THAT(refusal<CounterTable>(CMAP_TEST_NO_MODULE),
              AllOf(StartsWith(CMAP_TEST_NO_MODULE ": is no module of cmap "), EndsWith("of one build")));
}

TEST(LoadedModule, AMissingLibraryIsWhatThisBuildHasNot) {
  EXPECT_THAT(refusal<CounterTable>("libcmap_nowhere.so"),
              AllOf(StartsWith("this build cannot count: "), HasSubstr("libcmap_nowhere.so")));
}

TEST(LoadedModule, AFileThatIsNoLibraryNamesIt) {
  EXPECT_THAT(refusal<CounterTable>(__FILE__), AllOf(StartsWith("this build cannot count: "), HasSubstr(__FILE__)));
}

}  // namespace loaded_module_test
}  // namespace cmap
