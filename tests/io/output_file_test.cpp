#include "cmap/io/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "io/io_testing.hpp"

namespace cmap::testing {
namespace output_file_test {

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
  } catch (const OutputError& error) {
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

TEST(OutputFile, FollowsALinkThatLeadsToNothingYet) {
  const TempFolder folder;
  fs::create_symlink("target.txt", folder / "link.txt");
  OutputFile file(folder / "link.txt");
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_bytes(folder / "target.txt"), "new");
}

/// Whether the system of temporary files knows files without a name.
bool has_nameless_files(const TempFolder& folder) {
  const int descriptor = ::open(folder.path().c_str(), O_WRONLY | O_TMPFILE, 0600);
  if (descriptor >= 0) ::close(descriptor);
  return descriptor >= 0;
}

TEST(OutputFile, HasNoNameBeforeItIsComplete) {
  const TempFolder folder;
  if (!has_nameless_files(folder)) GTEST_SKIP() << "this file system knows no files without a name";
  OutputFile fresh(folder / "new.txt"), replaced(folder.write("old.txt", "old"));
  fresh.write("new");
  replaced.write("replaced");
  fresh.finish();
  replaced.finish();
  EXPECT_EQ(entries(folder), 1U) << "the old one";
  fresh.commit();
  replaced.commit();
  EXPECT_EQ(entries(folder), 2U);
  EXPECT_EQ(read_bytes(folder / "new.txt"), "new");
  EXPECT_EQ(read_bytes(folder / "old.txt"), "replaced");
}

TEST(OutputFile, WritersByNameFindIt) {
  const TempFolder folder;
  OutputFile file(folder / "out.txt");
  std::ofstream(file.path_for_writer()) << "by name";
  EXPECT_EQ(read_bytes(file.path_for_writer()), "by name");
  file.commit();
  EXPECT_EQ(read_bytes(folder / "out.txt"), "by name");
}

TEST(OutputFile, OfManyAtOnceSomeHaveATemporaryName) {
  constexpr std::size_t kMany = 300;  // more than may hold a descriptor each
  const TempFolder folder;
  OutputFiles files;
  for (std::size_t i = 0; i < kMany; ++i) {
    files.add(folder / std::to_string(i), [&](OutputFile& file) { file.write(std::to_string(i)); });
  }
  EXPECT_GT(entries(folder), 0U);
  files.commit();
  EXPECT_EQ(entries(folder), kMany);
  for (std::size_t i = 0; i < kMany; ++i) EXPECT_EQ(read_bytes(folder / std::to_string(i)), std::to_string(i));
}

TEST(OutputFiles, LeaveNothingWithoutCommit) {
  constexpr int kMany = 300;
  const TempFolder folder;
  {
    OutputFiles files;
    for (int i = 0; i < kMany; ++i) {
      files.add(folder / std::to_string(i), [](OutputFile& file) { file.write("x"); });
    }
  }
  EXPECT_EQ(entries(folder), 0U);
}

TEST(OutputFile, AReaderMayCloseItsPipe) {
  const TempFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  std::thread reader([&] { const std::ifstream closed_at_once(pipe); });
  {
    OutputFile file(pipe);
    reader.join();
    const std::string more(1 << 20, 'x');
    EXPECT_NO_THROW(file.write(more));
    EXPECT_NO_THROW(file.commit());
  }
  std::signal(SIGPIPE, before);
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
  EXPECT_THROW(file.commit(), OutputError);
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

}  // namespace output_file_test
}  // namespace cmap::testing
