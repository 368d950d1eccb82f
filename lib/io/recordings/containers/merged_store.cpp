#include "recordings/containers/merged_store.hpp"

#include <algorithm>

namespace cmap {
namespace {

/// A file, its topics' numbers here, and its next message.
struct Part {
  std::unique_ptr<MessageStore> store;
  std::vector<std::size_t> topic_of;
  StoredMessage message;
  bool has_message = false;

  void advance() {
    has_message = store->next(message);
    if (has_message) message.topic = topic_of[message.topic];
  }
};

class MergedStore : public MessageStore {
 public:
  explicit MergedStore(std::vector<std::unique_ptr<MessageStore>> stores) {
    for (std::unique_ptr<MessageStore>& store : stores) {
      Part part{std::move(store), {}, {}, false};
      for (const StoredTopic& topic : part.store->topics()) part.topic_of.push_back(add(topic, *part.store));
      parts_.push_back(std::move(part));
    }
  }

  const std::vector<StoredTopic>& topics() const override { return topics_; }

  void select(const std::vector<bool>& is_wanted) override {
    for (Part& part : parts_) {
      std::vector<bool> is_wanted_of_part;
      for (const std::size_t topic : part.topic_of) is_wanted_of_part.push_back(is_wanted[topic]);
      part.store->select(is_wanted_of_part);
    }
  }

  bool next(StoredMessage& message) override {
    if (last_ == nullptr) {
      for (Part& part : parts_) part.advance();
    } else {
      last_->advance();
    }
    last_ = nullptr;
    for (Part& part : parts_) {
      if (part.has_message && (last_ == nullptr || part.message.log_time_ns < last_->message.log_time_ns))
        last_ = &part;
    }
    if (last_ == nullptr) return false;
    message = last_->message;
    return true;
  }

  std::string place() const override { return last_ == nullptr ? std::string() : last_->store->place(); }

 private:
  std::size_t add(const StoredTopic& topic, const MessageStore& store) {
    const auto known = std::ranges::find(topics_, topic.name, &StoredTopic::name);
    if (known == topics_.end()) {
      topics_.push_back(topic);
      return topics_.size() - 1;
    }
    if (known->type != topic.type || known->encoding_name != topic.encoding_name) {
      throw InputError(fmt::format("{}: topic {} has messages of {} ({}), but of {} ({}) in the files before",
                                   store.place(), topic.name, topic.type, topic.encoding_name, known->type,
                                   known->encoding_name));
    }
    known->n_messages += topic.n_messages;
    return static_cast<std::size_t>(known - topics_.begin());
  }

  std::vector<Part> parts_;
  std::vector<StoredTopic> topics_;
  Part* last_ = nullptr;
};

}  // namespace

std::unique_ptr<MessageStore> merge_stores(std::vector<std::unique_ptr<MessageStore>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<MergedStore>(std::move(parts));
}

}  // namespace cmap
