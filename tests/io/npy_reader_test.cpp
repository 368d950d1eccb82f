#include <limits>

#include "io/capture_testing.hpp"
#include "io/npy_array.hpp"
#include "io/zip_archive.hpp"

namespace cmap::testing {
namespace {

using ::testing::HasSubstr;

NpyArray read_array(std::string_view content) {
  ByteSource source("a.npy", std::as_bytes(std::span(content)));
  return read_npy(source);
}

TEST(NpyArray, EveryTypeAndVersion) {
  for (const int major : {1, 2, 3}) {
    EXPECT_EQ(read_array(npy_text("'<f4'", "(2,)", raw<float>({1.5F, -2}), "False", major)).to_floats(),
              (Array<float>{1.5F, -2}));
  }
  EXPECT_EQ(read_array(npy_text("'<f2'", "(3,)", raw<U16>({0x3555, 0x7bff, 0xfc00}))).to_floats(),
            (Array<float>{0.333251953125F, 65504, -std::numeric_limits<float>::infinity()}));
  EXPECT_EQ(read_array(npy_text("'<f8'", "(1,)", raw<double>({0.1}))).to_doubles(), Array<double>{0.1});
  EXPECT_EQ(read_array(npy_text("'|u1'", "(2,)", "\x07\xff")).to_bytes(), (Array<U8>{7, 255}));
  EXPECT_EQ(read_array(npy_text("'|b1'", "(2,)", std::string("\0\1", 2))).to_bytes(), (Array<U8>{0, 1}));
  EXPECT_EQ(read_array(npy_text("'<i4'", "(1,)", raw<std::int32_t>({-7}))).to_doubles(), Array<double>{-7});
  EXPECT_EQ(read_array(npy_text("'<i8'", "(1,)", raw<std::int64_t>({1LL << 40}))).to_doubles(), Array<double>{0x1p40});
}

TEST(NpyArray, ShapesAsPythonWritesThem) {
  EXPECT_EQ(read_array(npy_text("'<f4'", "()", "1234")).size(), 1U);
  EXPECT_EQ(read_array(npy_text("'<f4'", "(1L, 1L)", "1234")).shape(), (std::vector<std::uint64_t>{1, 1}));
  EXPECT_EQ(read_array(npy_text("'<f4'", "(0, 3)", "")).size(), 0U);
  // In one dimension Fortran's order is C's.
  EXPECT_EQ(read_array(npy_text("'<f4'", "(1,)", "1234", "True")).size(), 1U);
}

TEST(NpyArray, MalformedHeaders) {
  const std::string good = npy_text("'<f4'", "(1,)", "1234");
  EXPECT_EQ(input_error([&] { read_array(good); }), "");
  const std::pair<std::string, std::string> kCases[] = {
      {"'descr'", "'descx'"}, {"'<f4'", "'<f4 "}, {"False", "Falsy"}, {"(1,)", "(1;)"},
      {"(1,)", "(-,)"},       {"{", "["},         {"}", " "},         {"'shape'", "'descr'"},
      {"False, ", "False  "}};
  for (const auto& [from, to] : kCases) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    EXPECT_THAT(input_error([&] { read_array(text); }), HasSubstr("a.npy: NPY header:")) << to;
  }
  EXPECT_THAT(input_error([&] { read_array(good.substr(0, 40)); }), HasSubstr("truncated: the NPY header"));
  Bytes huge("\x93NUMPY");
  huge.put(U8{2}, U8{0}, std::uint32_t{0xffffffff});
  EXPECT_THAT(input_error([&] { read_array(huge.str()); }), HasSubstr("4294967295 bytes; at most 65536"));
}

TEST(NpyArray, WrittenAsNumpyDoes) {
  const TempFolder folder;
  const float values[] = {1, 2, 3, 4, 5, 6};
  OutputFile file(folder / "a.npy");
  write_npy(file, NpyType::kFloat32, {2, 3}, values);
  file.commit();
  const std::string bytes = read_bytes(folder / "a.npy");
  EXPECT_EQ(bytes, npy_text("'<f4'", "(2, 3)", raw<float>({1, 2, 3, 4, 5, 6})));
  EXPECT_EQ((bytes.size() - 24) % 64, 0U) << "the values are aligned";
}

TEST(ZipArchive, StoredDeflatedAndZip64) {
  for (const bool deflate : {false, true}) {
    for (const bool zip64 : {false, true}) {
      ZipText text{deflate, zip64, {{"a", "content of a"}, {"folder/b", std::string(100000, 'b')}, {"empty", ""}}};
      const std::string bytes = text.str();
      const ZipArchive zip("a.zip", std::as_bytes(std::span(bytes)));
      ASSERT_EQ(zip.members().size(), 3U);
      for (const auto& [name, content] : text.members) {
        const ZipMember* member = zip.find(name);
        ASSERT_NE(member, nullptr);
        const Array<std::byte> read = zip.read(*member);
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(read.data()), read.size()), content);
        EXPECT_EQ(zip.read_start(*member, 5), content.substr(0, 5));
      }
      EXPECT_EQ(zip.find("c"), nullptr);
    }
  }
}

/// Cut at every length, and every byte changed: refused, or what was read is what was written.
TEST(ZipArchive, TruncatedAndDamagedFilesAreRefused) {
  for (const bool deflate : {false, true}) {
    const std::string bytes = ZipText{deflate, deflate, {{"a", "some content, some content"}}}.str();
    const auto read = [](std::string_view content) -> std::string {
      const ZipArchive zip("a.zip", std::as_bytes(std::span(content)));
      const ZipMember* member = zip.find("a");
      if (member == nullptr) throw InputError("no member a");
      const Array<std::byte> data = zip.read(*member);
      return {reinterpret_cast<const char*>(data.data()), data.size()};
    };
    ASSERT_EQ(read(bytes), "some content, some content");
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      EXPECT_THROW(read(bytes.substr(0, i)), InputError) << i;
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ 0x55);
      try {
        EXPECT_EQ(read(changed), "some content, some content") << i;
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("a"));
      }
    }
  }
}

TEST(ZipArchive, SaysWhatIsWrong) {
  const auto refusal_of = [](auto&& change) {
    std::string bytes = ZipText{false, false, {{"x.npy", "0123456789"}}}.str();
    change(bytes);
    return input_error([&] {
      const ZipArchive zip("a.zip", std::as_bytes(std::span(bytes)));
      zip.read(zip.members().at(0));
    });
  };
  const auto entry = [](const std::string& bytes) { return bytes.find("PK\x01\x02"); };
  EXPECT_EQ(refusal_of([](auto&) {}), "");
  EXPECT_THAT(refusal_of([](auto& b) { b.resize(b.size() - 1); }), HasSubstr("a.zip: truncated, or no ZIP file"));
  EXPECT_THAT(refusal_of([](auto& b) { b[36] = 'X'; }), HasSubstr("a.zip: member x.npy: is damaged: its checksum"));
  EXPECT_THAT(refusal_of([&](auto& b) { b[entry(b) + 8] = 1; }), HasSubstr("member x.npy: is encrypted"));
  EXPECT_THAT(refusal_of([&](auto& b) { b[entry(b) + 10] = 12; }), HasSubstr("compressed with method 12"));
  EXPECT_THAT(refusal_of([&](auto& b) { b[entry(b) + 42] = 5; }), HasSubstr("has no header where the directory says"));
  EXPECT_THAT(refusal_of([&](auto& b) { b[entry(b) + 24] = 11; }), HasSubstr("10 bytes cannot hold its 11"));
  EXPECT_THAT(refusal_of([&](auto& b) { b[entry(b)] = 'X'; }),
              HasSubstr("entry 1 of the central directory is damaged"));
  // A bomb: sizes are checked before memory is taken.
  std::string bomb = ZipText{true, false, {{"x.npy", "0123456789"}}}.str();
  bomb[entry(bomb) + 27] = '\x7f';
  const ZipArchive zip("a.zip", std::as_bytes(std::span(bomb)));
  EXPECT_THAT(input_error([&] { zip.read(zip.members()[0]); }), HasSubstr("cannot hold its 21"));
  EXPECT_THAT(input_error([] { ZipArchive("no/such.npz"); }), HasSubstr("no/such.npz: no such file"));
}

TEST(NpyCloud, ArraysOfPoints) {
  const auto file = read_content("a.npy", npy_text("'<f4'", "(2, 3)", raw<float>({1, 2, 3, 4, 5, 6})));
  EXPECT_EQ(file.info.format, "NPY <f4");
  EXPECT_EQ(file.cloud.positions, (Array<Eigen::Vector3f>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_FALSE(file.cloud.has_color());
  // UTM coordinates keep their millimeters; what is not finite is dropped.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto utm =
      read_content("a.npy", npy_text("'<f8'", "(1, 2, 3)", raw<double>({636000.001, 849000.002, 3, nan, 5, 6})));
  ASSERT_EQ(utm.cloud.size(), 1U);
  EXPECT_LT((point(utm, 0) - Eigen::Vector3d(636000.001, 849000.002, 3)).norm(), 1e-5);
  EXPECT_EQ(utm.info.points, 2U);
  EXPECT_THAT(refusal("a.npy", npy_text("'<f4'", "(3, 2)", raw<float>({1, 2, 3, 4, 5, 6}))),
              HasSubstr("(N, 3) expected"));
  EXPECT_THAT(refusal("a.npy", npy_text("'|u1'", "(2, 3)", "123456")), HasSubstr("values of type |u1"));
  EXPECT_THAT(refusal("a.npy", npy_text("'<f4'", "(0, 3)", "")), HasSubstr("holds no points"));
}

TEST(NpyCloud, NpzOfPointsMapsAndPredictions) {
  const std::string points = npy_text("'<f4'", "(2, 3)", raw<float>({1, 2, 3, 4, 5, 6}));
  const auto cloud_of = [&](ZipText text) { return read_content("a.npz", text.str()); };
  EXPECT_EQ(cloud_of({true, false, {{"arr_0.npy", points}}}).cloud.size(), 2U);
  EXPECT_EQ(cloud_of({true, true, {{"points.npy", points}, {"more.npy", points}}}).cloud.size(), 2U);
  const auto map =
      cloud_of({true, false, {{"pointcloud.npy", points}, {"mask.npy", npy_text("'|b1'", "(2,)", {"\0\1", 2})}}});
  EXPECT_EQ(map.cloud.positions, (Array<Eigen::Vector3f>{{4, 5, 6}}));
  EXPECT_THAT(all_notes(map), HasSubstr("1 of 2 points left out by the mask"));
  const auto session =
      cloud_of({false,
                false,
                {{"world_points.npy", npy_text("'<f4'", "(1, 1, 2, 3)", raw<float>({1, 2, 3, 4, 5, 6}))},
                 {"images.npy", npy_text("'<f4'", "(1, 3, 1, 2)", raw<float>({0, 1, 0.2F, 0, 0, 0.6F}))}}});
  EXPECT_EQ(session.info.format, "NPZ VGGT predictions");
  EXPECT_EQ(std::get<Array<Rgb8>>(session.cloud.colors), (Array<Rgb8>{{0, 51, 0}, {255, 0, 153}}));
  EXPECT_THAT(refusal("a.npz", (ZipText{false, false, {{"depth.npy", points}}}.str())),
              HasSubstr("a session for cmap_recon"));
  EXPECT_THAT(refusal("a.zip", (ZipText{false, false, {{"a.txt", "x"}, {"b.txt", "y"}}}.str())),
              HasSubstr("it holds a.txt, b.txt"));
  EXPECT_THAT(refusal("a.npz", "PK\x03\x04...."), HasSubstr("truncated, or no ZIP file"));
}

}  // namespace
}  // namespace cmap::testing
