#include <sqlite3.h>

#include "io/mcap_testing.hpp"

namespace cmap::testing {
namespace sqlite_store_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view kOldTopics =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT "
    "NULL);";
constexpr std::string_view kMessages =
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB "
    "NOT "
    "NULL);";

class SqliteStore : public ::testing::Test {
 protected:
  /// A file made by these statements.
  std::filesystem::path make(const std::string& statements) const {
    const std::filesystem::path path = folder_ / "drive_0.db3";
    std::filesystem::remove(path);
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
    char* error = nullptr;
    EXPECT_EQ(sqlite3_exec(database, statements.c_str(), nullptr, nullptr, &error), SQLITE_OK) << error;
    sqlite3_close(database);
    return path;
  }
  static std::vector<std::string> messages_in(const std::filesystem::path& path) {
    try {
      return messages_of(*open_message_store(path));
    } catch (const Error& error) {
      return {error.what()};
    }
  }
  static std::string drive() {
    return std::string(kOldTopics) + std::string(kMessages) +
           "INSERT INTO topics VALUES (7, '/a', 'a/msg/A', 'cdr'), (9, '/b', 'b/msg/B', 'cdr');"
           "INSERT INTO messages VALUES (1, 7, 50, X'61'), (2, 9, 30, X'62'), (3, 7, 50, X'63'), (4, 9, 40, X'');";
  }
  TempFolder folder_;
};

TEST_F(SqliteStore, MessagesComeByTimeThoseOfEqualTimesAsTheyStand) {
  const auto store = open_message_store(make(drive()));
  ASSERT_EQ(store->topics().size(), 2U);
  EXPECT_EQ(store->topics()[0].n_messages, 2U);
  EXPECT_EQ(store->topics()[1].type, "b/msg/B");
  EXPECT_THAT(messages_of(*store), ElementsAre("/b@30: b", "/b@40: ", "/a@50: a", "/a@50: c"));
}

TEST_F(SqliteStore, OnlyTheTopicsThatWereAskedFor) {
  const auto store = open_message_store(make(drive() + "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"));
  store->select({true, false});
  EXPECT_THAT(messages_of(*store), ElementsAre("/a@50: a", "/a@50: c"));
}

TEST_F(SqliteStore, WhatIsWrongIsNamed) {
  EXPECT_THAT(messages_in(make(drive() + "INSERT INTO messages VALUES (5, 8, 60, X'61');")),
              ElementsAre(HasSubstr("drive_0.db3: messages of topic 8, which is not listed")));
  EXPECT_THAT(messages_in(make(std::string(kMessages))), ElementsAre(HasSubstr("drive_0.db3: no such table: topics")));
  EXPECT_THAT(messages_in(make("CREATE TABLE messages(id INTEGER);" + std::string(kOldTopics))),
              ElementsAre(HasSubstr("no such column")));
}

TEST_F(SqliteStore, WhatIsCutOffOrChangedIsReadOrRefused) {
  const std::string whole = read_bytes(make(drive()));
  for (std::size_t n = 100; n < whole.size(); n += 500) {
    EXPECT_THAT(messages_in(folder_.write("cut.db3", whole.substr(0, n))), ::testing::Contains(HasSubstr("cut.db3: ")));
  }
  for (std::size_t i = 0; i < whole.size(); i += 41) {
    std::string changed = whole;
    changed[i] = static_cast<char>(~changed[i]);
    messages_in(folder_.write("changed.db3", changed));
  }
}

}  // namespace sqlite_store_test
}  // namespace cmap::testing
