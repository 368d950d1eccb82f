#include "fuzz/fuzz_target.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace {

/// Every input that the fuzzers start from or once found, through every reader, with every compiler.
std::size_t replay(const std::filesystem::path& folder) {
  std::size_t n = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().filename() == ".gitkeep") continue;
    const std::string bytes = read_bytes(entry.path());
    SCOPED_TRACE(entry.path());
    for (const fuzz::Reader reader : {read_ply, read_pcd, read_las, read_text}) {
      fuzz::try_reader(reader, std::as_bytes(std::span(bytes)));
    }
    ++n;
  }
  return n;
}

std::filesystem::path fuzz_folder() {
  const char* source = std::getenv("CMAP_SOURCE_DIR");
  return std::filesystem::path(source == nullptr ? "." : source) / "tests" / "fuzz";
}

TEST(FuzzRegressions, CorpusAndRegressionsAreReadOrRefused) {
  EXPECT_GE(replay(fuzz_folder() / "corpus"), 15U);
  replay(fuzz_folder() / "regressions");
}

TEST(FuzzRegressions, EverySeedIsReadByItsOwnReader) {
  const std::pair<const char*, fuzz::Reader> kReaders[] = {
      {"ply", read_ply}, {"pcd", read_pcd}, {"las", read_las}, {"text", read_text}};
  for (const auto& [name, reader] : kReaders) {
    for (const auto& entry : std::filesystem::directory_iterator(fuzz_folder() / "corpus" / name)) {
      ByteSource source(entry.path());
      FileInfo info;
      EXPECT_GT(reader(source, info).size(), 0U) << entry.path();
    }
  }
}

/// Every seed cut at every length, and with every byte changed: what a fuzzer does first.
TEST(FuzzRegressions, CutAndChangedSeedsAreReadOrRefused) {
  const std::pair<const char*, fuzz::Reader> kReaders[] = {
      {"ply", read_ply}, {"pcd", read_pcd}, {"las", read_las}, {"text", read_text}};
  for (const auto& [name, reader] : kReaders) {
    for (const auto& entry : std::filesystem::directory_iterator(fuzz_folder() / "corpus" / name)) {
      const std::string seed = read_bytes(entry.path());
      for (std::size_t i = 0; i < seed.size(); ++i) {
        std::string changed = seed;
        changed[i] = static_cast<char>(~changed[i]);
        fuzz::try_reader(reader, std::as_bytes(std::span(changed)));
        fuzz::try_reader(reader, std::as_bytes(std::span(seed)).first(i + 1));
      }
    }
  }
}

}  // namespace
}  // namespace cmap::testing
