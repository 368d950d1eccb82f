#include "stage_files.hpp"

#include "io/io_testing.hpp"

namespace cmap {
namespace stage_files_test {

using testing::read_bytes;
using testing::TempFolder;

struct Found {
  int number = 0;
};

template <class Fields>
void describe(Fields& f, StateOf<Fields, Found>& found) {
  f.field("number", found.number);
}

/// What a run with this key gets, which finds `number` where it has to look.
int run(const std::filesystem::path& folder, bool resume, const char* key, int number) {
  return StageFiles(folder, resume, key).found("stage", [&] { return Found{number}; }).number;
}

TEST(StageFiles, AResumedRunTakesWhatAnEarlierOneFound) {
  const TempFolder folder;
  EXPECT_EQ(run(folder / "stages", true, "key", 1), 1) << "there is nothing yet";
  EXPECT_EQ(run(folder / "stages", true, "key", 2), 1);
  EXPECT_EQ(run(folder / "stages", false, "key", 3), 3) << "not resumed";
  EXPECT_EQ(run(folder / "stages", true, "key", 4), 3) << "but kept";
}

TEST(StageFiles, WhatWasFoundFromAnotherKeyIsFoundAgain) {
  const TempFolder folder;
  run(folder / "stages", false, "key", 1);
  EXPECT_EQ(run(folder / "stages", true, "other", 2), 2);
  EXPECT_EQ(run(folder / "stages", true, "key", 3), 3) << "the file is that of the other key";
}

TEST(StageFiles, WhatIsNotAsItWasWrittenIsFoundAgain) {
  const TempFolder folder;
  run(folder / "stages", false, "key", 1);
  const std::string whole = read_bytes(folder / "stages/stage.json");
  for (const std::string& damaged :
       {std::string(), std::string("moon"), whole.substr(0, whole.size() / 2), std::string(R"({"key": "key"})"),
        std::string(R"({"key": "key", "found": 1})"), std::string(R"({"key": "key", "found": {"numbers": 1}})"),
        std::string(R"({"key": "key", "found": {"number": 1, "more": 1}})")}) {
    folder.write("stages/stage.json", damaged);
    EXPECT_EQ(run(folder / "stages", true, "key", 2), 2) << damaged;
    EXPECT_EQ(run(folder / "stages", true, "key", 3), 2) << "and mended";
  }
  folder.write("stages/stage.json", R"({"key": "key", "found": {"number": 5}})");
  EXPECT_EQ(run(folder / "stages", true, "key", 2), 5) << "the layout";
}

TEST(StageFiles, WithoutAFolderNothingIsKept) {
  EXPECT_EQ(run({}, true, "key", 1), 1);
  EXPECT_EQ(run({}, true, "key", 2), 2);
}

}  // namespace stage_files_test
}  // namespace cmap
