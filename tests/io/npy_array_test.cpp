#include "containers/npy_array.hpp"

#include <limits>

#include "containers/zip_archive.hpp"
#include "io/capture_testing.hpp"

namespace cmap::testing {
namespace npy_array_test {

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
  EXPECT_EQ(read_array(npy_text("'|i1'", "(2,)", "\xff\x05")).to_doubles(), (Array<double>{-1, 5}));
  EXPECT_EQ(read_array(npy_text("'<i2'", "(1,)", raw<std::int16_t>({-300}))).to_doubles(), Array<double>{-300});
  EXPECT_EQ(read_array(npy_text("'<u2'", "(1,)", raw<U16>({65535}))).to_doubles(), Array<double>{65535});
  EXPECT_EQ(read_array(npy_text("'<u4'", "(1,)", raw<std::uint32_t>({0xffffffff}))).to_doubles(),
            Array<double>{4294967295.0});
  EXPECT_EQ(read_array(npy_text("'<u8'", "(1,)", raw<std::uint64_t>({1ULL << 63}))).to_doubles(),
            Array<double>{0x1p63});
}

/// The bytes of each value as they stand in a file, most significant first.
TEST(NpyArray, BigEndian) {
  EXPECT_EQ(read_array(npy_text("'>f4'", "(2,)", {"\x3f\xc0\0\0\xc0\0\0\0", 8})).to_floats(), (Array<float>{1.5F, -2}));
  EXPECT_EQ(read_array(npy_text("'>f2'", "(2,)", "\x3e\x01\xfc\x01")).to_floats().at(0), 1.5009765625F);
  EXPECT_EQ(read_array(npy_text("'>f8'", "(1,)", {"\x40\x09\x21\xfb\x54\x44\x2d\x18", 8})).to_doubles(),
            Array<double>{3.141592653589793});
  EXPECT_EQ(read_array(npy_text("'>i2'", "(2,)", {"\x01\x02\xff\xfe", 4})).to_doubles(), (Array<double>{258, -2}));
  EXPECT_EQ(read_array(npy_text("'>u4'", "(1,)", {"\x01\x02\x03\x04", 4})).to_doubles(), Array<double>{16909060});
  EXPECT_EQ(read_array(npy_text("'>i8'", "(1,)", {"\xff\xff\xff\xff\xff\xff\xff\xfb", 8})).to_doubles(),
            Array<double>{-5});
}

/// In Fortran's order the first index is the fastest in the file: value (i, j, k) of shape (2, 3, 4) is the one at
/// i + 2 j + 6 k.
TEST(NpyArray, FortranOrder) {
  std::vector<float> stored(24);
  for (std::size_t i = 0; i < 24; ++i) stored[i] = static_cast<float>(i);
  const Array<float> values = read_array(npy_text("'<f4'", "(2, 3, 4)", raw(stored), "True")).to_floats();
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(values[12 * i + 4 * j + k], static_cast<float>(i + 2 * j + 6 * k));
    }
  }
  EXPECT_EQ(read_array(npy_text("'>i2'", "(2, 2)", {"\0\1\0\2\0\3\0\4", 8}, "True")).to_doubles(),
            (Array<double>{1, 3, 2, 4}));
  EXPECT_EQ(read_array(npy_text("'<f4'", "(3, 0)", "", "True")).size(), 0U);
  EXPECT_THAT(input_error([&] { read_array(npy_text("'<f4'", "(2, 3, 4)", raw(stored).substr(1), "True")); }),
              HasSubstr("truncated"));
}

NpyHeader header_of(std::string_view descr) {
  const std::string content = npy_text(descr, "(0,)", "");
  ByteSource source("a.npy", std::as_bytes(std::span(std::string_view(content))));
  return read_npy_header(source);
}

TEST(NpyArray, RecordsAsNumpyDescribesThem) {
  const NpyHeader aligned = header_of("[('x', '<f4'), ('id', '|u1'), ('', '|V3'), (('a title', 'rgb'), '>u2', (3,))]");
  ASSERT_EQ(aligned.fields.size(), 4U);
  EXPECT_EQ(aligned.item_bytes, 4U + 1 + 3 + 6);
  EXPECT_EQ(aligned.fields[2].name, "");
  EXPECT_EQ(aligned.fields[3].name, "rgb");
  EXPECT_EQ(aligned.fields[3].offset, 8U);
  EXPECT_EQ(aligned.fields[3].count, 3U);
  EXPECT_TRUE(aligned.fields[3].big_endian);
  const NpyHeader nested = header_of(
      "[('p', [('x', '<f4'), ('y', '<f4')]), ('n', [('x', '<f8')]), ('t', '<M8[ns]'), "
      "('s', '<U5'), ('many', [('a', '|u1'), ('b', '<i2')], (2, 3))]");
  EXPECT_EQ(nested.type_text(), "records of p.x, y, n.x, t, s, many");
  EXPECT_EQ(nested.item_bytes, 4U + 4 + 8 + 8 + 20 + 18);
  EXPECT_EQ(nested.fields[5].kind, NpyKind::kOther);
}

TEST(NpyArray, RecordsThatAreRefused) {
  const auto refusal_of = [](std::string_view descr) { return input_error([&] { header_of(descr); }); };
  EXPECT_THAT(refusal_of("[]"), HasSubstr("records without members"));
  EXPECT_THAT(refusal_of("[('x', '<f4'"), HasSubstr("malformed"));
  EXPECT_THAT(refusal_of("[('x' '<f4')]"), HasSubstr("malformed"));
  EXPECT_THAT(refusal_of("[('x', '|O')]"), HasSubstr("pickled Python objects"));
  EXPECT_THAT(refusal_of("[('x', '<f3')]"), HasSubstr("values of type '<f3'"));
  EXPECT_THAT(refusal_of("[('x', '<f4x')]"), HasSubstr("values of type '<f4x'"));
  EXPECT_THAT(refusal_of("[('x', '|V0')]"), HasSubstr("values of type '|V0'"));
  EXPECT_THAT(refusal_of("[('x', '|V99999999999999999999')]"), HasSubstr("values of type"));
  EXPECT_THAT(refusal_of("[('x', '<f4', (0,))]"), HasSubstr("absurd shape"));
  EXPECT_THAT(refusal_of("[('x', '<f4', (65536, 65536))]"), HasSubstr("absurd shape"));
  EXPECT_THAT(refusal_of("[('a', '|V60000'), ('b', '|V6000')]"), HasSubstr("more than the accepted 65536 bytes"));
  std::string deep;
  for (int i = 0; i < 1000; ++i) deep += "[('a', ";
  EXPECT_THAT(refusal_of(deep), HasSubstr("more than 8 deep"));
  // As plain numbers only what is one can be had.
  EXPECT_THAT(input_error([] { read_array(npy_text("[('x', '<f4')]", "(1,)", "1234")).to_floats(); }),
              HasSubstr("records of x; plain numbers expected"));
  EXPECT_THAT(input_error([] { read_array(npy_text("'<c8'", "(1,)", "12345678")).to_doubles(); }),
              HasSubstr("<c8; plain numbers expected"));
  EXPECT_THAT(input_error([] { read_array(npy_text("'<f4'", "(4611686018427387904, 4)", "")); }), HasSubstr("absurd"));
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
  write_npy(file, ScalarType::kFloat32, {2, 3}, values);
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

}  // namespace npy_array_test
}  // namespace cmap::testing
