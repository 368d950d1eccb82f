#include "cmap/io/byte_source.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <thread>

#include "cmap/io/line_reader.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace byte_source_test {

using ::testing::HasSubstr;

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

std::string open_failure(const std::filesystem::path& path) {
  try {
    const ByteSource source(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// Lines of every length around the block size, so that blocks end everywhere in them.
std::string many_lines(std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; text.size() < bytes; ++i) text += std::to_string(i) + std::string(i % 97, '.') + "\n";
  return text;
}

TEST(ByteSource, SaysWhyItCannotOpen) {
  const TempFolder folder;
  EXPECT_EQ(open_failure("/no/such/file.ply"), "/no/such/file.ply: no such file");
  EXPECT_THAT(open_failure(folder.path()), HasSubstr("is a folder, not a file"));
  EXPECT_THAT(open_failure(folder.write("empty.ply", "")), HasSubstr("empty.ply: the file is empty"));
  EXPECT_THAT(open_failure("/dev/null"), HasSubstr("neither a regular file nor a pipe"));
  EXPECT_THAT(open_failure(folder.write("x", "y") / "z"), HasSubstr("cannot be opened: Not a directory"));
}

TEST(ByteSource, YieldsEveryByteOnceAcrossBlocks) {
  const TempFolder folder;
  const std::string text = many_lines(3 * ByteSource::kBlockBytes + 12345);
  ByteSource source(folder.write("lines.txt", text), true);
  std::string seen;
  for (std::size_t step = 1; !source.peek(step).empty(); step = step * 3 % 65521) {
    const std::size_t n = std::min(step, source.peek(step).size());
    seen += text_of(source.peek(step).first(n));
    source.advance(n);
  }
  EXPECT_EQ(seen, text);
  EXPECT_EQ(source.remaining(), 0U);
}

TEST(ByteSource, ReadsAnywhereWithoutMoving) {
  const TempFolder folder;
  const auto path = folder.write("a", "0123456789");
  const std::string text = "0123456789";
  ByteSource file(path, true), memory("a", bytes_of(text), true);
  for (ByteSource* source : {&file, &memory}) {
    source->skip(4, "four bytes");
    std::array<std::byte, 3> out{};
    EXPECT_EQ(source->read_at(2, out), 3U);
    EXPECT_EQ(text_of(out), "234");
    EXPECT_EQ(source->read_at(8, out), 2U) << "the end";
    EXPECT_EQ(text_of(out).substr(0, 2), "89");
    EXPECT_EQ(source->read_at(10, out), 0U);
    EXPECT_EQ(source->read_at(~std::uint64_t{0}, out), 0U);
    EXPECT_EQ(text_of(source->peek(1)), "456789");
  }
  EXPECT_EQ(file.finish_sha256(), memory.finish_sha256());
}

TEST(ByteSource, HashesTheWholeFileHoweverMuchWasRead) {
  // FIPS 180-2, example B.1.
  constexpr std::string_view kAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  const TempFolder folder;
  const auto path = folder.write("abc", "abc");
  ByteSource untouched(path, true);
  EXPECT_EQ(untouched.finish_sha256(), kAbc);
  ByteSource started(path, true);
  started.skip(2, "two bytes");
  EXPECT_EQ(started.finish_sha256(), kAbc);
  EXPECT_EQ(ByteSource(path).finish_sha256(), "");
}

TEST(ByteSource, TruncationNamesTheBytes) {
  ByteSource source("mem", bytes_of("0123456789"));
  source.skip(4, "a start");
  try {
    source.skip(7, "a body");
    FAIL() << "must not skip past the end";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "mem: truncated: a body at byte 4 takes 7 bytes, but the file ends at byte 10");
  }
}

TEST(ByteSource, ReadsPipes) {
  const TempFolder folder;
  const std::string text = many_lines(ByteSource::kBlockBytes + 777);
  const auto pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << text; });
  ByteSource source(pipe);
  writer.join();
  EXPECT_EQ(source.size(), text.size());
  std::string seen(text.size(), ' ');
  source.read(std::as_writable_bytes(std::span(seen)), "all");
  EXPECT_EQ(seen, text);
}

TEST(ByteSource, NoticesAFileThatShrinks) {
  const TempFolder folder;
  const auto path = folder.write("x", std::string(2 * ByteSource::kBlockBytes, 'x'));
  ByteSource source(path);
  source.skip(100, "a start");
  ASSERT_EQ(::truncate(path.c_str(), 1000), 0);
  EXPECT_THROW(source.skip(2 * ByteSource::kBlockBytes - 100, "the rest"), InputError);
}

TEST(LineReader, SplitsAcrossBlocksAndCountsLines) {
  const std::string text = many_lines(3 * ByteSource::kMaxRecordBytes);
  ByteSource source("mem", bytes_of(text));
  LineReader lines(source);
  std::string joined;
  std::uint64_t n = 0;
  for (std::string_view line; lines.next(line); ++n) joined += std::string(line) + "\n";
  EXPECT_EQ(joined, text);
  EXPECT_EQ(lines.number(), n);
}

TEST(LineReader, TakesEveryLineEnd) {
  ByteSource source("mem", bytes_of("a\r\n\nb\nc"));
  LineReader lines(source);
  std::vector<std::string> seen;
  for (std::string_view line; lines.next(line);) seen.emplace_back(line);
  EXPECT_EQ(seen, (std::vector<std::string>{"a", "", "b", "c"}));
}

std::vector<std::string> lines_of(std::string_view text) {
  ByteSource source("mem", bytes_of(text));
  LineReader lines(source);
  std::vector<std::string> seen;
  for (std::string_view line; lines.next(line);) seen.emplace_back(line);
  return seen;
}

TEST(LineReader, TakesLineEndsThatAreMixed) {
  using Lines = std::vector<std::string>;
  for (const char* text : {"a\r\nb\rc\nd", "a\nb\rc\r\nd\r\n", "a\rb\nc\r\nd\n", "a\rb\r\nc\rd\r", "a\r\nb\nc\rd"}) {
    EXPECT_EQ(lines_of(text), (Lines{"a", "b", "c", "d"})) << text;
  }
  EXPECT_EQ(lines_of("a\r\rb\n\nc\r\n\r\nd"), (Lines{"a", "", "b", "", "c", "", "d"}));
  EXPECT_EQ(lines_of("a\r\r\nb\r\r\nc"), (Lines{"a", "", "b", "", "c"})) << "text mode on Windows";
  EXPECT_EQ(lines_of("\r"), Lines{""});
}

/// Long runs of each kind, so that blocks end within and between ends of every kind.
TEST(LineReader, TakesMixedLineEndsAcrossBlocks) {
  const std::string_view ends[] = {"\n", "\r\n", "\r"};
  std::string text;
  std::vector<std::string> expected;
  for (std::size_t i = 0; text.size() < 3 * ByteSource::kMaxRecordBytes; ++i) {
    expected.push_back(std::string(1 + i * 7 % 60, 'x'));
    text += expected.back();
    text += ends[i / 997 % 3];
  }
  EXPECT_EQ(lines_of(text), expected);
}

/// What follows a header may begin with a byte that looks like the rest of its line end.
TEST(LineReader, LeavesDataBehindALoneCr) {
  for (const auto& [text, left] : {std::pair{"a\rb\r\ndata", "\ndata"},
                                   {"a\nb\n\rdata", "\rdata"},
                                   {"a\r\nb\r\ndata", "data"},
                                   {"a\r\nb\r\n\ndata", "\ndata"}}) {
    ByteSource source("mem", bytes_of(text));
    LineReader lines(source);
    std::string_view line;
    ASSERT_TRUE(lines.next(line) && lines.next(line));
    EXPECT_EQ(line, "b");
    EXPECT_EQ(source.remaining(), std::string_view(left).size()) << text;
  }
}

TEST(LineReader, RefusesEndlessLines) {
  const std::string text(ByteSource::kMaxRecordBytes + 10, 'x');
  ByteSource source("mem", bytes_of(text));
  LineReader lines(source);
  std::string_view line;
  EXPECT_THROW(lines.next(line), InputError);
}

}  // namespace byte_source_test
}  // namespace cmap::testing
