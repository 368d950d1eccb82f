#include <lz4frame.h>

#include "io/mcap_testing.hpp"

namespace cmap::testing {
namespace mcap_store_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> messages_in(const std::string& file) {
  try {
    return messages_of(*mcap_of(file));
  } catch (const Error& error) {
    return {error.what()};
  }
}

McapText start() {
  return McapText().header().schema(1, "a/A").channel(1, 1, "/a").schema(2, "b/msg/B").channel(2, 2, "/b", "cdr");
}

std::string packed_by_lz4(const std::string& text) {
  std::string packed(LZ4F_compressFrameBound(text.size(), nullptr), '\0');
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), text.data(), text.size(), nullptr));
  return packed;
}

TEST(McapStore, TopicsWithTheirTypesAndNumbers) {
  const std::string file = start().message(1, 5, "x").message(2, 6, "y").message(1, 7, "z").end().file();
  const auto store = mcap_of(file);
  ASSERT_EQ(store->topics().size(), 2U);
  EXPECT_EQ(store->topics()[0].type, "a/A");
  EXPECT_EQ(store->topics()[0].encoding(), MessageEncoding::kRos1);
  EXPECT_EQ(store->topics()[0].n_messages, 2U);
  EXPECT_EQ(store->topics()[1].type, "b/msg/B");
  EXPECT_EQ(store->topics()[1].encoding(), MessageEncoding::kCdr);
  EXPECT_THAT(messages_of(*store), ElementsAre("/a@5: x", "/b@6: y", "/a@7: z"));
}

TEST(McapStore, MessagesComeByTimeAndThoseOfEqualTimesAsTheyStand) {
  const std::string file =
      start().message(1, 5, "a").message(1, 3, "b").message(2, 5, "c").message(1, 3, "d").end().file();
  EXPECT_THAT(messages_in(file), ElementsAre("/a@3: b", "/a@3: d", "/a@5: a", "/b@5: c"));
}

TEST(McapStore, ChunksThatOverlapOrAreOutOfOrderAreMerged) {
  const McapText late = start().message(1, 30, "late"),
                 first = McapText().message(1, 1, "a").message(1, 9, "c").message(1, 20, "e"),
                 second = McapText().message(2, 8, "b").message(2, 9, "d");
  const std::string file = McapText().header().chunk(late, 30, 30).chunk(first, 1, 20).chunk(second, 8, 9).end().file();
  EXPECT_THAT(messages_in(file), ElementsAre("/a@1: a", "/b@8: b", "/a@9: c", "/b@9: d", "/a@20: e", "/a@30: late"));
}

TEST(McapStore, OnlyTheTopicsThatWereAskedFor) {
  const std::string file = start().message(1, 5, "x").message(2, 6, "y").end().file();
  const auto store = mcap_of(file);
  store->select({false, true});
  EXPECT_THAT(messages_of(*store), ElementsAre("/b@6: y"));
}

TEST(McapStore, Lz4) {
  const std::string records = start().message(1, 5, std::string(1000, 'x')).str(), packed = packed_by_lz4(records);
  const auto file = [&](std::uint64_t bytes, std::string_view of) {
    return McapText().header().chunk(of, bytes, McapText::crc(records), "lz4", 5, 5).end().file();
  };
  EXPECT_THAT(messages_in(file(records.size(), packed)), ElementsAre("/a@5: " + std::string(1000, 'x')));
  EXPECT_THAT(messages_in(file(records.size() - 1, packed)), ElementsAre(HasSubstr("lz4: more than the chunk says")));
  EXPECT_THAT(messages_in(file(records.size() + 1, packed)), ElementsAre(HasSubstr("bytes unpacked, but")));
  EXPECT_THAT(messages_in(file(records.size(), packed.substr(0, 40))), ElementsAre(HasSubstr("bytes unpacked, but")));
  EXPECT_THAT(messages_in(file(records.size(), "no frame at all")), ElementsAre(HasSubstr("lz4: ERROR_")));
  EXPECT_THAT(messages_in(file(std::uint64_t{1} << 60, packed)), ElementsAre(HasSubstr("at most")));
}

TEST(McapStore, AnUnknownCompressionIsNamed) {
  const std::string file = McapText().header().chunk("abc", 3, 0, "snappy", 0, 0).end().file();
  EXPECT_THAT(messages_in(file),
              ElementsAre("test.mcap: the chunk at byte 33: compression \"snappy\"; none, lz4 and zstd "
                          "are read (mcap compress writes them)"));
  EXPECT_THROW(mcap_of(file), UnsupportedError);
}

TEST(McapStore, AWrongChecksumIsAnErrorWhereItsMessagesCome) {
  const McapText first = start().message(1, 5, "x"), second = McapText().message(1, 6, "y");
  const std::string file =
      McapText().header().chunk(first, 5, 5).chunk(second.str(), second.str().size(), 1, "", 6, 6).end().file();
  EXPECT_THAT(messages_in(file), ElementsAre("/a@5: x", HasSubstr("checksum 0x00000001, but the bytes have 0x")));
}

TEST(McapStore, MessagesOutsideOfChunksAreHeldToTheChecksumOfTheFile) {
  const McapText body = start().message(1, 5, "x");
  const auto file = [&](std::uint32_t crc) {
    McapText text = body;
    text.record(15, Bytes().put(crc).str());
    return text.record(2, Bytes().put(std::uint64_t{0}, std::uint64_t{0}, std::uint32_t{0}).str()).file();
  };
  EXPECT_THAT(messages_in(file(McapText::crc(std::string(McapText::kMagic) + body.str()))), ElementsAre("/a@5: x"));
  EXPECT_THAT(messages_in(file(77)), ElementsAre(HasSubstr("checksum 0x0000004d of all before")));
}

TEST(McapStore, WhatIsCutOffGivesWhatStandsBefore) {
  const std::string file = McapText()
                               .header()
                               .chunk(start().message(1, 5, "x"), 5, 5)
                               .chunk(McapText().message(1, 6, "y"), 6, 6)
                               .end()
                               .file();
  std::size_t most = 0;
  for (std::size_t n = 1; n < file.size(); ++n) {
    const std::vector<std::string> found = messages_in(file.substr(0, n));
    ASSERT_FALSE(found.empty());
    EXPECT_THAT(found.back(), StartsWith("test.mcap: ")) << n;
    if (n >= McapText::kMagic.size()) {
      EXPECT_THAT(found.back(), HasSubstr("truncated")) << n;
    }
    most = std::max(most, found.size());
  }
  EXPECT_EQ(most, 3U) << "both messages, and the error";
}

TEST(McapStore, WhatCannotBeIsNamed) {
  EXPECT_THAT(messages_in(start().message(3, 5, "x").end().file()),
              ElementsAre(HasSubstr("channel 3, which was not declared")));
  EXPECT_THAT(messages_in(start().channel(1, 1, "/other").end().file()),
              ElementsAre(HasSubstr("channel 1 is of /other, and was of /a")));
  EXPECT_THAT(messages_in(start().channel(3, 2, "/a").end().file()),
              ElementsAre(HasSubstr("two channels of topic /a")));
  EXPECT_THAT(messages_in(start().record(5, "short").end().file()), ElementsAre(HasSubstr("the record at byte")));
  EXPECT_THAT(messages_in(start().record(0, "").end().file()), ElementsAre(HasSubstr("a record of kind 0")));
  EXPECT_THAT(messages_in(start().record(99, "of somebody else").message(1, 5, "x").end().file()),
              ElementsAre("/a@5: x"));
  EXPECT_THAT(messages_in("not MCAP"), ElementsAre("test.mcap: is no MCAP file"));
}

}  // namespace mcap_store_test
}  // namespace cmap::testing
