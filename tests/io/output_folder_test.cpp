#include "cmap/io/output_folder.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "cmap/core/error.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace output_folder_test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// What opening the folder is refused with; empty if it is not.
std::string refusal(const fs::path& path) {
  try {
    const OutputFolder folder(path);
  } catch (const OutputError& error) {
    return error.what();
  }
  return {};
}

/// Begins to fill the folder and is killed.
void begin_and_die(const fs::path& path) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    OutputFolder folder(path);
    std::ofstream(folder.subfolder("part") / "half") << "old";
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

using Names = std::vector<std::string>;

TEST(OutputFolder, AppearsOnlyWhenCommitted) {
  const TempFolder folder;
  OutputFolder output(folder / "new");
  std::ofstream(output.partial() / "file") << "text";
  EXPECT_EQ(names_in(folder.path()), Names{"new.partial"});
  output.commit();
  EXPECT_EQ(names_in(folder.path()), Names{"new"});
  EXPECT_EQ(names_in(folder / "new"), Names{"file"}) << "nothing of ours stays";
}

TEST(OutputFolder, LeavesNothingWithoutCommit) {
  const TempFolder folder;
  { std::ofstream(OutputFolder(folder / "new").subfolder("part") / "half") << "text"; }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(OutputFolder, TheRestOfAKilledRunIsReplaced) {
  const TempFolder folder;
  begin_and_die(folder / "new");
  EXPECT_TRUE(fs::exists(folder / "new.partial/part/half"));
  OutputFolder output(folder / "new");
  std::ofstream(output.partial() / "file") << "text";
  output.commit();
  EXPECT_EQ(names_in(folder.path()), Names{"new"});
  EXPECT_EQ(names_in(folder / "new"), Names{"file"}) << "nothing of the killed run";
}

/// Killed before it could leave a mark.
TEST(OutputFolder, AnEmptyRestIsReplaced) {
  const TempFolder folder;
  fs::create_directory(folder / "new.partial");
  EXPECT_EQ(refusal(folder / "new"), "");
}

TEST(OutputFolder, WhatAnotherProgramFillsIsRefused) {
  const TempFolder folder;
  OutputFolder first(folder / "new");
  std::ofstream(first.partial() / "file") << "text";
  EXPECT_THAT(refusal(folder / "new"), HasSubstr("new.partial: cannot be written: another program is writing into it"));
  first.commit();
  EXPECT_EQ(names_in(folder / "new"), Names{"file"});
  EXPECT_THAT(refusal(folder / "new"), HasSubstr("new: cannot be written: it is already there"));
}

TEST(OutputFolder, SomebodysDataAreNotTouched) {
  const TempFolder folder;
  fs::create_directory(folder / "new.partial");
  std::ofstream(folder / "new.partial/mine") << "mine";
  EXPECT_THAT(refusal(folder / "new"), HasSubstr("new.partial is there, and is not what a run that was stopped"));
  EXPECT_EQ(names_in(folder / "new.partial"), Names{"mine"});
  folder.write("file.partial", "mine");
  EXPECT_THAT(refusal(folder / "file"), HasSubstr("file: cannot be written: File exists"));
  EXPECT_EQ(read_bytes(folder / "file.partial"), "mine");
}

TEST(OutputFolder, AFolderThatAppearsMeanwhileIsNotReplaced) {
  const TempFolder folder;
  {
    OutputFolder output(folder / "new");
    fs::create_directory(folder / "new");
    EXPECT_THROW(output.commit(), OutputError);
  }
  EXPECT_EQ(names_in(folder.path()), Names{"new"});
}

TEST(OutputFolder, NamesPathAndReason) {
  const TempFolder folder;
  EXPECT_THAT(refusal(folder / "no/such/new"), HasSubstr("no/such/new: cannot be written: No such file"));
}

TEST(FolderLock, OneAtATime) {
  const TempFolder folder;
  {
    const FolderLock first(folder.path());
    EXPECT_TRUE(first.is_held());
    EXPECT_TRUE(first.is_of(folder.path()));
    EXPECT_FALSE(first.is_of("/"));
    EXPECT_THROW(FolderLock(folder.path()), OutputError);
  }
  EXPECT_TRUE(FolderLock(folder.path()).is_held());
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_THROW(FolderLock(folder / "missing"), OutputError);
}

}  // namespace output_folder_test
}  // namespace cmap::testing
