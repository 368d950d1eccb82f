#include "cmap/io/output_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::size_t entries(const TempFolder& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

std::string write_failure(const fs::path& path) {
  try {
    OutputFile file(path);
    const std::string block(1 << 16, 'x');
    for (int i = 0; i < 4; ++i) file.write(block);
    file.commit();
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

TEST(OutputFile, AppearsOnlyWhenCommitted) {
  const TempFolder folder;
  OutputFile file(folder / "out.txt");
  file.write("hello ");
  file.write("world");
  EXPECT_FALSE(fs::exists(folder / "out.txt"));
  file.commit();
  EXPECT_EQ(read_bytes(folder / "out.txt"), "hello world");
  EXPECT_EQ(entries(folder), 1U);
}

TEST(OutputFile, LeavesNothingWithoutCommit) {
  const TempFolder folder;
  { OutputFile(folder / "out.txt").write("half"); }
  EXPECT_EQ(entries(folder), 0U);
}

TEST(OutputFile, KeepsTheOldFileUntilCommit) {
  const TempFolder folder;
  const fs::path path = folder.write("out.txt", "old");
  {
    OutputFile file(path);
    file.write("new");
    EXPECT_EQ(read_bytes(path), "old");
  }
  EXPECT_EQ(read_bytes(path), "old");
  OutputFile file(path);
  file.write("new");
  file.commit();
  EXPECT_EQ(read_bytes(path), "new");
}

TEST(OutputFile, KeepsPermissionsOfTheOldFile) {
  const TempFolder folder;
  const fs::path path = folder.write("out.txt", "old");
  ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
  OutputFile file(path);
  file.commit();
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640U);
}

TEST(OutputFile, FollowsALink) {
  const TempFolder folder;
  const fs::path target = folder.write("target.txt", "old");
  fs::create_symlink("target.txt", folder / "link.txt");
  OutputFile file(folder / "link.txt");
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_bytes(target), "new");
}

TEST(OutputFile, NamesPathAndReason) {
  const TempFolder folder;
  EXPECT_THAT(write_failure(folder / "no/such/out.txt"), HasSubstr("no/such/out.txt: cannot be written: No such file"));
  EXPECT_THAT(write_failure(folder.path()), HasSubstr("Is a directory"));
  folder.write("file", "");
  EXPECT_THAT(write_failure(folder / "file/out.txt"), HasSubstr("Not a directory"));
}

TEST(OutputFile, DetectsAFullDisk) {
  EXPECT_THAT(write_failure("/dev/full"), HasSubstr("/dev/full: cannot be written: No space left on device"));
  // One byte stays in the buffer until commit.
  OutputFile file("/dev/full");
  file.write("x");
  EXPECT_THROW(file.commit(), UsageError);
}

TEST(OutputFile, WritesDevicesAndPipesDirectly) {
  const TempFolder folder;
  EXPECT_EQ(write_failure("/dev/null"), "");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string received;
  std::thread reader([&] { received = read_bytes(pipe); });
  {
    OutputFile file(pipe);
    file.write("through the pipe");
    file.commit();
  }
  reader.join();
  EXPECT_EQ(received, "through the pipe");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

}  // namespace
}  // namespace cmap::testing
