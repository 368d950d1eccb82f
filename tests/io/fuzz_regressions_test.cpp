#include "fuzz/fuzz_target.hpp"
#include "io/io_testing.hpp"

namespace cmap::testing {
namespace fuzz_regressions_test {

/// The folder of a format's seeds: "COLMAP text" has colmap_text.
std::string folder_of(const CloudFormat& format) {
  std::string folder;
  for (const char c : format.name) {
    if (std::isalnum(static_cast<unsigned char>(c))) folder += static_cast<char>(std::tolower(c));
    if (c == ' ') folder += '_';
  }
  return folder;
}

/// Every input that the fuzzers start from or once found, through every reader, with every compiler.
std::size_t replay(const std::filesystem::path& folder) {
  std::size_t n = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().filename() == ".gitkeep") continue;
    const std::string bytes = read_bytes(entry.path());
    SCOPED_TRACE(entry.path());
    for (const CloudFormat* format : cloud_formats()) fuzz::try_format(*format, std::as_bytes(std::span(bytes)));
    fuzz::try_any(std::as_bytes(std::span(bytes)));
    fuzz::try_session(std::as_bytes(std::span(bytes)));
    fuzz::try_capture(std::as_bytes(std::span(bytes)));
    fuzz::try_transform(std::as_bytes(std::span(bytes)));
    fuzz::try_trajectory(std::as_bytes(std::span(bytes)));
    fuzz::try_recording(std::as_bytes(std::span(bytes)));
    fuzz::try_recorded_message(std::as_bytes(std::span(bytes)));
    ++n;
  }
  return n;
}

std::filesystem::path fuzz_folder() {
  const char* source = std::getenv("CMAP_SOURCE_DIR");
  return std::filesystem::path(source == nullptr ? "." : source) / "tests" / "fuzz";
}

TEST(FuzzRegressions, CorpusAndRegressionsAreReadOrRefused) {
  EXPECT_GE(replay(fuzz_folder() / "corpus"), 20U);
  replay(fuzz_folder() / "regressions");
}

TEST(FuzzRegressions, EverySeedIsReadByItsOwnReader) {
  for (const CloudFormat* format : cloud_formats()) {
    for (const auto& entry : std::filesystem::directory_iterator(fuzz_folder() / "corpus" / folder_of(*format))) {
      ByteSource source(entry.path());
      FileInfo info;
      EXPECT_GT(format->read(source, info, {}).size(), 0U) << entry.path();
    }
  }
}

TEST(FuzzRegressions, EverySessionAndCaptureSeedIsRead) {
  const auto bytes_of = [](std::string_view name) { return read_bytes(fuzz_folder() / "corpus" / name); };
  for (const std::string_view name : {"session/predictions", "session/predictions_deflated"}) {
    const std::string bytes = bytes_of(name);
    SessionPredictions session;
    std::size_t frames = 0;
    const ArrayStore store("seed", std::as_bytes(std::span(bytes)));
    read_depth(store, session, frames);
    read_images(store, session, frames);
    read_intrinsics(store, session, frames);
    read_poses(store, session, frames);
    make_first_camera_the_frame(store, session);
    EXPECT_EQ(frames, 2U);
  }
  EXPECT_EQ(parse_capture_json(bytes_of("capture/pinhole"), "seed").calibration.camera.distortion.size(), 5U);
  EXPECT_EQ(parse_capture_json(bytes_of("capture/fisheye"), "seed").calibration.camera.distortion.size(), 4U);
}

TEST(FuzzRegressions, EveryTransformAndTrajectorySeedIsRead) {
  for (const auto& entry : std::filesystem::directory_iterator(fuzz_folder() / "corpus" / "transform")) {
    ByteSource source(entry.path());
    EXPECT_NE(parse_transform(source).T, Eigen::Matrix4d::Identity()) << entry.path();
  }
  for (const auto& entry : std::filesystem::directory_iterator(fuzz_folder() / "corpus" / "trajectory")) {
    ByteSource source(entry.path());
    EXPECT_EQ(parse_trajectory(source).poses.size(), 2U) << entry.path();
  }
}

TEST(FuzzRegressions, EverySeedOfARecordingIsRead) {
  for (const auto& entry : std::filesystem::directory_iterator(fuzz_folder() / "corpus" / "recording")) {
    const std::string bytes = read_bytes(entry.path());
    const auto store = open_mcap(std::make_unique<ByteSource>("seed", std::as_bytes(std::span(bytes))));
    StoredMessage message;
    std::size_t n = 0;
    while (store->next(message)) ++n;
    EXPECT_EQ(n, 3U) << entry.path();
  }
  std::size_t n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(fuzz_folder() / "corpus" / "recorded_message")) {
    const std::string bytes = read_bytes(entry.path());
    const auto message = std::as_bytes(std::span(bytes));
    MessageDecoder decoder(static_cast<MessageKind>(bytes[0]),
                           bytes[1] == 1 ? MessageEncoding::kRos1 : MessageEncoding::kCdr, PointTimeUnit::kAuto, 1.0);
    EXPECT_NO_THROW(decoder.decode(message.subspan(2), std::nullopt)) << entry.path();
    ++n;
  }
  EXPECT_GE(n, 12U);
}

/// Every seed cut at every length, and with every byte changed: what a fuzzer does first.
TEST(FuzzRegressions, CutAndChangedSeedsAreReadOrRefused) {
  for (const CloudFormat* format : cloud_formats()) {
    for (const auto& entry : std::filesystem::directory_iterator(fuzz_folder() / "corpus" / folder_of(*format))) {
      const std::string seed = read_bytes(entry.path());
      for (std::size_t i = 0; i < seed.size(); ++i) {
        std::string changed = seed;
        changed[i] = static_cast<char>(~changed[i]);
        fuzz::try_format(*format, std::as_bytes(std::span(changed)));
        fuzz::try_format(*format, std::as_bytes(std::span(seed)).first(i + 1));
      }
    }
  }
}

TEST(FuzzRegressions, CutAndChangedSessionsCapturesAndPosesAreReadOrRefused) {
  for (const auto& [name, attempt] :
       {std::pair{"session", &fuzz::try_session}, std::pair{"capture", &fuzz::try_capture},
        std::pair{"transform", &fuzz::try_transform}, std::pair{"trajectory", &fuzz::try_trajectory},
        std::pair{"recording", &fuzz::try_recording}, std::pair{"recorded_message", &fuzz::try_recorded_message}}) {
    for (const auto& entry : std::filesystem::directory_iterator(fuzz_folder() / "corpus" / name)) {
      const std::string seed = read_bytes(entry.path());
      for (std::size_t i = 0; i < seed.size(); ++i) {
        std::string changed = seed;
        changed[i] = static_cast<char>(~changed[i]);
        attempt(std::as_bytes(std::span(changed)));
        attempt(std::as_bytes(std::span(seed)).first(i + 1));
      }
    }
  }
}

}  // namespace fuzz_regressions_test
}  // namespace cmap::testing
