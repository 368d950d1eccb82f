// The main of a module's test program: with a file's name ("accuracy") it runs the tests of accuracy_test.cpp alone.

#include <gtest/gtest.h>

#include <iostream>
#include <string>
#include <string_view>

namespace {

/// A filter for the tests that stand in the file; empty if there are none.
std::string tests_of_file(std::string_view name) {
  std::string ending(1, '/');
  ending.append(name).append("_test.cpp");
  std::string filter;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestInfo& test = *suite.GetTestInfo(t);
      if (!std::string_view(test.file()).ends_with(ending)) continue;
      if (!filter.empty()) filter += ':';
      filter.append(suite.name()).append(1, '.').append(test.name());
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc > 1) {
    const std::string filter = tests_of_file(argv[1]);
    if (filter.empty()) {
      std::cerr << "no test in " << argv[1] << "_test.cpp\n";
      return 1;
    }
    GTEST_FLAG_SET(filter, filter);
  }
  return RUN_ALL_TESTS();
}
