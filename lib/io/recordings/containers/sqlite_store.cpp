#include "recordings/containers/sqlite_store.hpp"

#include <sqlite3.h>

#include <map>

#include "cmap/core/execution.hpp"

namespace cmap {
namespace {

class Database {
 public:
  explicit Database(const std::filesystem::path& path) : name_(path.string()) {
    if (sqlite3_open_v2(path.c_str(), &database_, SQLITE_OPEN_READONLY, nullptr) != SQLITE_OK) {
      const std::string reason = sqlite3_errmsg(database_);
      sqlite3_close(database_);
      throw InputError(fmt::format("{}: cannot be opened: {}", name_, reason));
    }
  }
  ~Database() { sqlite3_close_v2(database_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  sqlite3* get() const { return database_; }
  const std::string& name() const { return name_; }
  [[noreturn]] void fail() const { throw InputError(fmt::format("{}: {}", name_, sqlite3_errmsg(database_))); }

 private:
  std::string name_;
  sqlite3* database_ = nullptr;
};

class Query {
 public:
  Query(const Database& database, const std::string& text) : database_(database) {
    if (sqlite3_prepare_v2(database.get(), text.c_str(), -1, &query_, nullptr) != SQLITE_OK) database.fail();
  }
  ~Query() { sqlite3_finalize(query_); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  bool next() {
    const int result = sqlite3_step(query_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) database_.fail();
    return result == SQLITE_ROW;
  }
  void restart_with(std::int64_t value) {
    sqlite3_reset(query_);
    sqlite3_bind_int64(query_, 1, value);
  }
  std::int64_t whole(int column) { return sqlite3_column_int64(query_, column); }
  std::string text(int column) {
    const auto* text = sqlite3_column_text(query_, column);
    return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
  }
  std::span<const std::byte> blob(int column) {
    const auto* bytes = static_cast<const std::byte*>(sqlite3_column_blob(query_, column));
    return {bytes, bytes == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(query_, column))};
  }

 private:
  const Database& database_;
  sqlite3_stmt* query_ = nullptr;
};

class SqliteStore : public MessageStore {
 public:
  explicit SqliteStore(const std::filesystem::path& path) : database_(path) {
    Query topics(database_, "SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    while (topics.next()) {
      topic_of_id_[topics.whole(0)] = topics_.size();
      topics_.push_back({topics.text(1), topics.text(2), topics.text(3), 0});
    }
    Query counts(database_, "SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id");
    while (counts.next()) {
      topics_[topic_of(counts.whole(0))].n_messages = static_cast<std::uint64_t>(counts.whole(1));
    }
  }

  const std::vector<StoredTopic>& topics() const override { return topics_; }

  void select(const std::vector<bool>& is_wanted) override {
    std::vector<std::int64_t> ids;
    for (const auto& [id, topic] : topic_of_id_) {
      if (is_wanted[topic]) ids.push_back(id);
    }
    condition_ = fmt::format(" WHERE topic_id IN ({})", fmt::join(ids, ","));
  }

  /// Order and messages are asked for one after the other: where a recording has no index of times, the database sorts
  /// numbers in place of messages.
  bool next(StoredMessage& message) override {
    throw_if_stopped();
    if (!order_) {
      order_ = std::make_unique<Query>(database_, "SELECT id FROM messages" + condition_ + " ORDER BY timestamp, id");
      message_ = std::make_unique<Query>(database_, "SELECT topic_id, timestamp, data FROM messages WHERE id = ?1");
    }
    if (!order_->next()) return false;
    id_ = order_->whole(0);
    message_->restart_with(id_);
    if (!message_->next()) throw InputError(place() + ": is not there");
    message = {topic_of(message_->whole(0)), message_->whole(1), message_->blob(2)};
    return true;
  }

  std::string place() const override { return fmt::format("{}: message {}", database_.name(), id_); }

 private:
  std::size_t topic_of(std::int64_t id) const {
    const auto found = topic_of_id_.find(id);
    if (found != topic_of_id_.end()) return found->second;
    throw InputError(fmt::format("{}: messages of topic {}, which is not listed", database_.name(), id));
  }

  Database database_;
  std::vector<StoredTopic> topics_;
  std::map<std::int64_t, std::size_t> topic_of_id_;
  std::string condition_;
  std::unique_ptr<Query> order_, message_;
  std::int64_t id_ = 0;
};

}  // namespace

std::unique_ptr<MessageStore> open_sqlite(const std::filesystem::path& path) {
  return std::make_unique<SqliteStore>(path);
}

}  // namespace cmap
